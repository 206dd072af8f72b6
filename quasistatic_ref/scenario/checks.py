"""Scenarios that cannot be meant: numbers out of this world, pairs that never act, or act twice."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.model.system import System
from quasistatic_ref.tolerances import LARGE, WELDED


def check_sizes(value: Any, name: str = "") -> None:
    """Refuse numbers so large that their products leave the range of float64.

    Parameters
    ----------
    value : object
        As parsed. What is not finite is left to the field's own reader.
    name : str
        Dotted name of the value.

    Raises
    ------
    ScenarioError
    """
    if isinstance(value, dict):
        for key, inner in value.items():
            check_sizes(inner, f"{name}.{key}" if name else key)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            check_sizes(inner, name if isinstance(inner, int | float) else f"{name}[{i}]")
    elif isinstance(value, int | float) and LARGE < abs(value) < float("inf"):
        raise ScenarioError(f"must be at most {LARGE:g}", field=name, value=value)


def check_motion(system: System, pairs: Sequence[ContactPair]) -> None:
    """Refuse what cannot move.

    Raises
    ------
    ScenarioError
        If there are no coordinates at all, or a pair's two links never move relative to each
        other, so that its rows are zero.
    """
    if not system.n_v:
        problem = 'nothing here can move; give a body base = "floating", or a URDF with joints'
        raise ScenarioError(problem, field="bodies")
    kinematics = system.kinematics(system.q_start)
    for pair in pairs:
        a, b = pair.alpha.link, pair.beta.link
        nu_a, omega_a = kinematics.J[a, :3], kinematics.J[a, 3:]
        nu_b, omega_b = kinematics.J[b, :3], kinematics.J[b, 3:]
        arm = kinematics.t[b] - kinematics.t[a]
        # Velocities of alpha's link, extended to the origin of beta's.
        nu_at_b = nu_a + np.cross(omega_a, arm, axis=0)
        scale = 1 + np.abs(arm).max()
        if max(np.abs(nu_b - nu_at_b).max(), np.abs(omega_b - omega_a).max()) <= WELDED * scale:
            problem = "its two sides cannot move relative to each other, so it can never act"
            raise ScenarioError(problem, field=f"contacts.{pair.name}")
