"""A flat body pushed by a round finger over its support, as steps of Eq. :eq:`eq-13`.

The coordinates are those of the finger, q_a = (x, y), and of the body, q_u = (x, y, z, angle) of
its centre of mass. The finger is
an upright post that is smooth along its length, and touches at the height of the support: pushes
do not load one side of the body more than the other.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.reality.outline import Outline, rotation
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.lab.scenes.contacts import GRAVITY, contacts_of
from quasistatic_ref.lab.scenes.slider import turned
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData

PATCH = ((0.0, 0.0),)
"""One contact, below the centre of mass [m]."""

SLOWEST = 0.05
"""Largest quasi-dynamic number [-]: the model's own drag is then 5 % of friction at most."""

NO_TORSION = 1e-3
"""Ratio that stands for a support without torsional friction [m]: one of zero would leave how far
a body turns on a push through its centre to its inertia."""


@dataclass(frozen=True, eq=False)
class Pushed:
    """The body, its support and the finger.

    Parameters
    ----------
    outline : Outline
        In the body's frame; its centre is that of mass.
    radius : float
        Of the finger [m].
    mu_finger : float
        Its friction [-].
    ratio : float
        mu_omega / mu_v of the support [m]; of several contacts, that of each.
    points : tuple of (float, float)
        Contacts of the support, from the centre of mass [m].
    by : Settings
        How steps are taken.
    """

    outline: Outline
    radius: float
    mu_finger: float
    ratio: float
    points: tuple[tuple[float, float], ...]
    by: Settings

    @property
    def n_u(self) -> int:
        """Four coordinates of a body that stays level, six of one that may tilt."""
        return 4 if len(self.points) == 1 else 6

    def step(self, finger: Array, body: Array, target: Array) -> StepData:
        """The step in which the finger is sent to a target.

        Parameters
        ----------
        finger, target : ndarray, shape (2,)
            World [m].
        body : ndarray, shape (4,) or (6,)
            Centre of mass x, y, height z [m], angle and tilts about x and y [rad].
        """
        by = self.by
        centre = self.outline.centre
        angle = body[3]
        R = rotation(angle)
        distance, on, normal = self.outline.closest(R.T @ (finger - body[:2]) + centre)
        arm = R @ (on - centre)
        n = R @ normal
        feet = np.asarray(self.points) @ R.T
        count = len(feet)
        n_u = self.n_u

        J = np.zeros((count + 1, 4, 2 + n_u))
        J[:count, :3, 2:5] = np.eye(3)
        J[:count, 0, 5], J[:count, 1, 5], J[:count, 3, 5] = -feet[:, 1], feet[:, 0], 1.0
        phi = np.full(count + 1, body[2])
        if n_u == 6:  # heights change with the tilts about x and y
            tilts = np.column_stack([feet[:, 1], -feet[:, 0]])
            J[:count, 2, 6:] = tilts
            phi[:count] += tilts @ body[4:]
        J[count, :2, :2], J[count, :2, 2:4] = -np.eye(2), np.eye(2)
        J[count, :2, 5], J[count, 3, 5] = turned(arm), 0.0
        phi[count] = distance - self.radius

        frames = np.zeros((count + 1, 3, 3))
        frames[:count] = np.eye(3)
        frames[count] = [[-n[1], n[0], 0.0], [0.0, 0.0, 1.0], [n[0], n[1], 0.0]]
        frames[count, 0] *= np.sign(np.linalg.det(frames[count]))

        weight = by.m * GRAVITY
        inertia = by.m * by.gyration**2
        tau = np.zeros(n_u)
        tau[2] = -weight
        lifted = by.m * by.rise
        M = np.array([by.m, by.m, lifted] + [inertia] * (n_u - 3))
        rows = np.array([6] * count + [4])
        torsion = [by.mu_v * self.ratio] * count + [0.0]
        mu_v = [by.mu_v] * count + [self.mu_finger]
        return StepData(
            h=by.h, K_q=by.stiffness * np.eye(2), M_u=np.diag(M),
            tau_a=np.zeros(2), tau_u=tau, delta_q_bar_a=target - finger,
            contacts=contacts_of(phi, frames, J, mu_v, torsion, rows), cone=by.cone,
        )  # fmt: skip


def pushed_scene(by: Settings, pair: Pair, ratio: float) -> Pushed:
    """The scene of a pair with an identified `ratio` mu_omega / mu_v [m].

    Raises
    ------
    InputError
        If there is no such cone, the pair has no such friction of the finger, or the
        quasi-dynamic number is too large.
    """
    cone(by.cone)
    if not by.quasi_dynamic_number <= SLOWEST:
        problem = f"makes the quasi-dynamic number more than {SLOWEST:g}; take a longer step"
        raise InputError(problem, field="h", value=by.h)
    return Pushed(
        pair.outline, pair.radius, by.friction(pair),
        ratio * by.torsion or NO_TORSION,
        PATCH, by,
    )  # fmt: skip
