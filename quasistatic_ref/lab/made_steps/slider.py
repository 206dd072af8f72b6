"""A slider on one soft contact, pushed along the plane: (R28), in the ellipsoid, and its step."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import GRAVITY, Z, contacts_of
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import StepData

M, GYRATION, STIFFNESS, H = 0.3, 0.03, 1e6, 0.01
"""Mass [kg], radius of gyration [m], of the pusher [N/m], time step [s]."""

TILT = 0.2
"""Angle of a sticking pusher's normal with its force [rad]."""

MU_PUSHER = 1.0
"""Friction of a sticking pusher [-]; it holds up to an angle of pi / 4."""


RADII = (0.02, GYRATION, 0.045)
SPEEDS = np.geomspace(1e-3, 3.0, 9)
"""mu_omega / mu_v [m] and quasi-dynamic numbers [-] at which it turns."""


@dataclass(frozen=True, eq=False)
class Push:
    """A push in closed form, (R28).

    Parameters
    ----------
    point : ndarray, shape (2,)
        Where the pusher touches, from the centre of mass [m].
    normal : ndarray, shape (2,)
        Of the pusher, into the slider.
    mu_pusher, mu_v, mu_omega : float
        [-], [-], [m].
    gap : float
        Of the support, before [m].
    motion : ndarray, shape (3,)
        Of the slider: x, y [m], angle [rad].
    rise, load : float
        Of the slider [m]; on the support [N].
    force : ndarray, shape (2,)
        Of the pusher on the slider [N].
    """

    point: Array
    normal: Array
    mu_pusher: float
    mu_v: float
    mu_omega: float
    gap: float
    motion: Array
    rise: float
    load: float
    force: Array

    @property
    def advance(self) -> Array:
        """Displacement of the pusher, shape (2,) [m]: one without friction is moved along n."""
        touched: Array = self.motion[:2] + self.motion[2] * turned(self.point)
        along: Array = self.normal * (self.normal @ touched)
        return touched if self.mu_pusher else along

    @property
    def friction(self) -> Array:
        """Force and torque of the support, shape (3,): normal to the limit surface where it is."""
        scale = np.array([1.0, 1.0, self.mu_omega / self.mu_v])
        along = scale * self.motion
        force: Array = -self.mu_v * self.load * scale * along / np.linalg.norm(along)
        return force


def turned(x: Array) -> Array:
    """A vector of the plane, shape (2,), turned by 90 degrees."""
    return np.array([-x[1], x[0]])


def rotated(x: Array, angle: float) -> Array:
    """A vector of the plane, shape (2,), turned by an angle [rad]."""
    result: Array = x * np.cos(angle) + turned(x) * np.sin(angle)
    return result


def sticking_motion(point: Array, advance: Array, chi2: float) -> Array:
    """Motion (3,) of a slider whose touched point (2,) [m] is moved by `advance` (2,) [m].

    It is Lynch's, if chi2 is (mu_omega / mu_v)^2.
    """
    velocity: Array = (chi2 * advance + point * (point @ advance)) / (chi2 + point @ point)
    return np.append(velocity, turned(point) @ velocity / chi2)


def sliding_motion(point: Array, normal: Array, chi2: float) -> Array:
    """Motion (3,) of a slider whose touched point (2,) [m] advances by 1 [m], without friction."""
    arm = turned(point) @ normal
    motion: Array = np.append(normal, arm / chi2) / (1 + arm**2 / chi2)
    return motion


def push(
    point: Array,
    direction: Array,
    *,
    mu_v: float,
    chi: float,
    Pi: float,
    lifted: float,
    sticks: bool,
) -> Push:
    """A push along a direction at a quasi-dynamic number; the size of its motion follows.

    Parameters
    ----------
    point, direction : ndarray, shape (2,)
        Where it touches [m], and which way it goes [-].
    mu_v, chi : float
        chi = mu_omega / mu_v [m].
    Pi : float
        M / h^2 over N mu_v^2 / s, the gap after the step being s [-].
    lifted : float
        Gap before the step over that after it: 0 on the floor, 1 in steady motion [-].
    sticks : bool
        Whether the pusher does, or is without friction.
    """
    chi2 = (chi**2 + Pi * GYRATION**2) / (1 + Pi)
    if sticks:
        motion = sticking_motion(point, direction, chi2)
        normal = rotated(motion[:2] / np.linalg.norm(motion[:2]), TILT)
    else:
        motion = sliding_motion(point, direction, chi2)
        normal = direction
    s = Pi * mu_v**2 * GRAVITY * H**2 / (1 - Pi * mu_v**2 * (1 - lifted))
    motion = motion * s / (mu_v * np.linalg.norm(motion * [1, 1, chi]))
    rise = (1 - lifted) * s
    load = M * GRAVITY + M * rise / H**2
    force = (M / H**2 + load * mu_v**2 / s) * motion[:2]
    return Push(
        point, normal, MU_PUSHER if sticks else 0.0, mu_v, mu_v * chi, lifted * s,
        motion, rise, load, force,
    )  # fmt: skip


def push_step(of: Push) -> StepData:
    """The step of a push: q_a is the pusher's x, y; q_u the slider's x, y, z and angle.

    The pusher is an upright post that is smooth along its length: it does not feel the rise.
    """
    normal = np.append(of.normal, 0.0)
    across = np.append(-turned(of.normal), 0.0)
    J = np.zeros((2, 4, 6))
    J[0, :, 2:] = np.eye(4)
    J[1, :2, :2], J[1, :2, 2:4], J[1, :2, 5] = -np.eye(2), np.eye(2), turned(of.point)
    return StepData(
        h=H,
        K_q=STIFFNESS * np.eye(2),
        M_u=np.diag([M, M, M, M * GYRATION**2]),
        tau_a=np.zeros(2),
        tau_u=[0, 0, -M * GRAVITY, 0],
        delta_q_bar_a=of.advance + of.force / STIFFNESS,
        contacts=contacts_of(
            [of.gap, 0.0], np.array([np.eye(3), [Z, across, normal]]), J,
            [of.mu_v, of.mu_pusher], [of.mu_omega, 0.0], rows=6,
        ),
        cone=ELLIPSOID,
    )  # fmt: skip


def turns(chi: float) -> list[float]:
    """Turn over that of Lynch's relation, chi^2 omega = r x v, at each speed."""
    point = np.array([0.03, 0.02])
    direction = np.array([0.0, 1.0])
    ratios = []
    for Pi in SPEEDS:
        of = push(point, direction, mu_v=0.4, chi=chi, Pi=Pi, lifted=1.0, sticks=True)
        motion = exact(push_step(of)).delta_q[2:]
        ratios.append(chi**2 * motion[3] / (turned(point) @ motion[:2]))
    return ratios
