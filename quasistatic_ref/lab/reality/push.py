"""A flat body pushed by a round finger over its support, as steps of Eq. :eq:`eq-13`.

The coordinates are those of the finger, q_a = (x, y), and of the body, q_u = (x, y, z, angle) of
its centre of mass; where its support is more than one contact, the two tilts follow. The finger is
an upright post that is smooth along its length, and touches at the height of the support: pushes
do not load one side of the body more than the other.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.lab.scenes.contacts import GRAVITY, contacts_of
from quasistatic_ref.lab.scenes.slider import turned
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Array, StepData

PATCH: Final = ((0.0, 0.0),)
"""One contact, below the centre of mass [m]."""


@dataclass(frozen=True, eq=False)
class Pushed:
    """The body, its support and the finger; and how steps are taken.

    Parameters
    ----------
    outline : Outline
        In the body's frame.
    centre : ndarray, shape (2,)
        Of mass, in the body's frame [m].
    radius : float
        Of the finger [m].
    mu_finger : float
        Its friction [-].
    ratio : float
        mu_omega / mu_v of the support [m]; of several contacts, that of each.
    cone : str
    points : tuple of (float, float)
        Contacts of the support, from the centre of mass [m].
    advance : float
        Of the finger in a step [m].
    axes : float
        Angle of d1 of the support from the world's x [rad].
    nudge : tuple of float
        Force along x and y, and torque over the radius of gyration, of something else on the body
        over mu_v m g [-].
    m, gyration : float
        Mass [kg], radius of gyration [m].
    rise : float
        Mass that a rise lifts, over m [-]: 1, or 1e-6 as of a planar base with `support`.
    law : str
        ``"convex"``, or ``"coulomb"`` for steps without a rise.
    mu_v, h, stiffness : float
        [-], [s], of the finger [N/m].
    """

    outline: Outline
    centre: Array
    radius: float
    mu_finger: float
    ratio: float
    cone: str = ELLIPSOID
    points: tuple[tuple[float, float], ...] = PATCH
    advance: float = 5e-4
    axes: float = 0.0
    nudge: tuple[float, float, float] = (0.0, 0.0, 0.0)
    m: float = 1.0
    gyration: float = 0.04
    mu_v: float = 0.3
    h: float = 0.5
    stiffness: float = 1e6
    rise: float = 1.0
    law: str = CONVEX

    @property
    def n_u(self) -> int:
        """Four coordinates of a body that stays level, six of one that may tilt."""
        return 4 if len(self.points) == 1 else 6

    @property
    def quasi_dynamic_number(self) -> float:
        """Pi = v / (mu_v g h) of a body that goes as fast as the finger [-]."""
        return self.advance / (self.mu_v * GRAVITY * self.h**2)

    def step(self, finger: Array, body: Array, target: Array) -> StepData:
        """The step in which the finger is sent to a target.

        Parameters
        ----------
        finger, target : ndarray, shape (2,)
            World [m].
        body : ndarray, shape (4,) or (6,)
            Centre of mass x, y, height z [m], angle and tilts about x and y [rad].
        """
        angle = body[3]
        cos, sin = np.cos(angle), np.sin(angle)
        R = np.array([[cos, -sin], [sin, cos]])
        distance, on, normal = self.outline.closest(R.T @ (finger - body[:2]) + self.centre)
        arm, n = R @ (on - self.centre), R @ normal
        feet = np.asarray(self.points) @ R.T
        count, n_u = len(feet), self.n_u

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

        c, s = np.cos(self.axes), np.sin(self.axes)
        frames = np.zeros((count + 1, 3, 3))
        frames[:count] = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
        frames[count] = [[-n[1], n[0], 0.0], [0.0, 0.0, 1.0], [n[0], n[1], 0.0]]
        frames[count, 0] *= np.sign(np.linalg.det(frames[count]))

        weight, inertia = self.m * GRAVITY, self.m * self.gyration**2
        friction = self.mu_v * weight * np.array([1.0, 1.0, self.gyration])
        extra = friction * self.nudge
        tau = np.zeros(n_u)
        tau[:4] = extra[0], extra[1], -weight, extra[2]
        lifted = self.m * self.rise
        M = np.array([self.m, self.m, lifted] + [inertia] * (n_u - 3))
        rows = np.array([6] * count + [4])
        torsion = [self.mu_v * self.ratio] * count + [0.0]
        mu_v = [self.mu_v] * count + [self.mu_finger]
        return StepData(
            h=self.h, K_q=self.stiffness * np.eye(2), M_u=np.diag(M),
            tau_a=np.zeros(2), tau_u=tau, delta_q_bar_a=target - finger,
            contacts=contacts_of(phi, frames, J, mu_v, torsion, rows), cone=self.cone,
        )  # fmt: skip
