"""How far a run is from physics: its quasi-dynamic number and its boundary layer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from quasistatic_ref.model.system import System
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import BEARS, SLOW


def quasi_dynamic_number(system: System, step: StepData, delta_q: Array, g: float) -> float | None:
    """Pi = v / (mu_v g h) of one step: the spurious drag m v / h over the friction mu_v m g.

    v is that of the fastest un-actuated floating base, mu_v the least of the contacts that rub.

    Parameters
    ----------
    system : System
    step : StepData
    delta_q : ndarray, shape (n_v,)
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    float or None
        None where nothing floats, nothing rubs or nothing weighs.
    """
    bases = [j.v.start for j in system.joints if j.kind == "floating" and not j.actuated]
    rough = step.contacts.mu_v[step.contacts.mu_v > 0]
    if not (bases and rough.size and g > 0):
        return None
    v = max(float(np.linalg.norm(delta_q[start : start + 3])) for start in bases) / step.h
    return v / (float(rough.min()) * g * step.h)


def boundary_layer(step: StepData, solution: StepSolution) -> float:
    """Largest gap [m] that a contact with load has after the step, to first order; 0 without."""
    force = solution.wrench[:, 2]
    loaded = force > BEARS * force.max(initial=0.0)
    motion = step.contacts.motion(solution.delta_q)[:, :3]
    gap = step.contacts.phi + np.sum(step.contacts.n * motion, axis=1)
    return max(0.0, float(gap[loaded].max(initial=0.0)))


def warning(header: Mapping[str, Any]) -> str | None:
    """One sentence on a run whose Pi is not small, or None."""
    Pi = header["quasi_dynamic_number"]
    if Pi is None or Pi <= SLOW:
        return None
    return (
        f"the quasi-dynamic number of this run reaches {Pi:.2g}: the spurious drag m v / h is that "
        "many times friction at the fastest moment; move more slowly or take larger steps "
        "(the documentation's page 'Where the model is wrong')"
    )
