"""A flat body pushed by a round finger over its support, as steps of Eq. :eq:`eq-13`.

The coordinates are those of the finger, q_a = (x, y), and of the body, q_u = (x, y, z, angle) of
its centre of mass. The finger is
an upright post that is smooth along its length, and touches at the height of the support: pushes
do not load one side of the body more than the other.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.made_steps.contacts import GRAVITY, contacts_of
from quasistatic_ref.lab.made_steps.slider import turned
from quasistatic_ref.lab.reality.measurements import Pair
from quasistatic_ref.lab.reality.outline import Outline, rotation
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData

FINGER = 0.00475
"""Radius of the finger [m]."""

SLOWEST = 0.05
"""Largest quasi-dynamic number [-]: the model's own drag is then 5 % of friction at most."""


@dataclass(frozen=True, eq=False)
class Pushed:
    """The body, its support and the finger.

    Parameters
    ----------
    outline : Outline
        In the body's frame; its centre is that of mass.
    mu_finger : float
        Friction of the finger [-].
    ratio : float
        mu_omega / mu_v of the support [m], which is one contact below the centre of mass.
    by : Settings
        How steps are taken.
    """

    outline: Outline
    mu_finger: float
    ratio: float
    by: Settings

    def step(self, finger: Array, body: Array, target: Array) -> StepData:
        """The step in which the finger is sent to a target.

        Parameters
        ----------
        finger, target : ndarray, shape (2,)
            World [m].
        body : ndarray, shape (4,)
            Centre of mass x, y, height z [m], and angle [rad].
        """
        by = self.by
        centre = self.outline.centre
        R = rotation(body[3])
        distance, on, normal = self.outline.closest(R.T @ (finger - body[:2]) + centre)
        arm = R @ (on - centre)
        n = R @ normal

        J = np.zeros((2, 4, 6))
        J[0, :3, 2:5] = np.eye(3)
        J[0, 3, 5] = 1.0
        J[1, :2, :2] = -np.eye(2)
        J[1, :2, 2:4] = np.eye(2)
        J[1, :2, 5] = turned(arm)
        phi = [body[2], distance - FINGER]

        at_finger = np.array([[-n[1], n[0], 0.0], [0.0, 0.0, 1.0], [n[0], n[1], 0.0]])
        at_finger[0] *= np.sign(np.linalg.det(at_finger))
        frames = np.stack([np.eye(3), at_finger])

        inertia = by.m * by.gyration**2
        mu_v = [by.mu_v, self.mu_finger]
        torsion = [by.mu_v * self.ratio, 0.0]
        return StepData(
            h=by.h, K_q=by.stiffness * np.eye(2), M_u=np.diag([by.m, by.m, by.m, inertia]),
            tau_a=np.zeros(2), tau_u=np.array([0.0, 0.0, -by.m * GRAVITY, 0.0]),
            delta_q_bar_a=target - finger,
            contacts=contacts_of(phi, frames, J, mu_v, torsion, [6, 4]), cone=by.cone,
        )  # fmt: skip


def pushed_scene(by: Settings, pair: Pair, ratio: float) -> Pushed:
    """The scene of a pair with an identified `ratio` mu_omega / mu_v [m].

    Raises
    ------
    InputError
        If the quasi-dynamic number is too large.
    """
    if not by.quasi_dynamic_number <= SLOWEST:
        problem = f"makes the quasi-dynamic number more than {SLOWEST:g}; take a longer step"
        raise InputError(problem, field="h", value=by.h)
    return Pushed(pair.outline, pair.mu_finger, ratio, by)
