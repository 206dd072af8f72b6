"""Steps built by hand: rigid bodies against fixed surfaces, without a robotics stack.

The coordinates of a body are its twist at the centre of mass, axes along the world's.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array, Contacts, StepData
from quasistatic_ref.step.solution import StepSolution

GRAVITY = 9.81
"""Acceleration of free fall in every scene of this room [m/s^2]."""

X, Y, Z = np.eye(3)


def cross_matrix(r: Array) -> Array:
    """[r]x, so that [r]x w = r x w; shape (3, 3)."""
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0.0]])


def contacts_of(
    phi: ArrayLike,
    frames: ArrayLike,
    J: ArrayLike,
    mu_v: ArrayLike,
    mu_omega: ArrayLike = 0.0,
    rows: int = 4,
) -> Contacts:
    """Contacts from frames [d1, d2, n], each 3 x 3 with these as its rows."""
    J = np.asarray(J, dtype=np.float64)
    n_c = len(J)
    frames = np.asarray(frames, dtype=np.float64).reshape(n_c, 3, 3)
    return Contacts(
        name=tuple(f"point/{j}" for j in range(n_c)),
        phi=np.broadcast_to(phi, n_c),
        n=frames[:, 2],
        d1=frames[:, 0],
        d2=frames[:, 1],
        J=J,
        mu_v=np.broadcast_to(mu_v, n_c),
        mu_omega=np.broadcast_to(mu_omega, n_c),
        rows=np.full(n_c, rows),
    )


def twist_jacobian(point: Array, n: Array) -> Array:
    """J of Eq. :eq:`eq-3` of a body's point [m] against the world, shape (4, 6)."""
    J = np.zeros((4, 6))
    J[:3, :3], J[:3, 3:] = np.eye(3), -cross_matrix(point)
    J[3, 3:] = n
    return J


def free_step(M: ArrayLike, force: ArrayLike, contacts: Contacts, h: float) -> StepData:
    """A step without anything actuated."""
    none = np.zeros(0)
    return StepData(h, np.zeros((0, 0)), np.asarray(M), none, np.asarray(force), none, contacts)


def rigid_step(
    m: float,
    inertia: ArrayLike,
    wrench: ArrayLike,
    points: ArrayLike,
    frames: ArrayLike,
    *,
    mu_v: ArrayLike,
    mu_omega: ArrayLike = 0.0,
    phi: ArrayLike = 0.0,
    rows: int = 4,
    h: float = 0.01,
) -> StepData:
    """One rigid body that touches the world.

    Parameters
    ----------
    m : float
        [kg].
    inertia : array_like, shape () or (3,)
        Principal moments along the axes of the world [kg m^2].
    wrench : array_like, shape (6,)
        Force and torque at the centre of mass, gravity included [N, N m].
    points : array_like, shape (n_c, 3)
        Contact points from the centre of mass [m].
    frames : array_like, shape (n_c, 3, 3)
        Rows d1, d2, n; n points from the world into the body.
    mu_v, mu_omega, phi, rows, h
        Those of the notation, each for all contacts or for one after the other.
    """
    points = np.reshape(points, (-1, 3))
    frames = np.reshape(frames, (-1, 3, 3))
    J = [twist_jacobian(r, frame[2]) for r, frame in zip(points, frames, strict=True)]
    M = np.diag([m, m, m, *np.broadcast_to(inertia, 3)])
    return free_step(M, wrench, contacts_of(phi, frames, J, mu_v, mu_omega, rows), h)


def point_step(
    m: float, force: ArrayLike, mu_v: float, phi: float, h: float, frame: ArrayLike | None = None
) -> StepData:
    """A point mass over a plane; delta_q is its displacement in the world [m]."""
    J = np.zeros((1, 4, 3))
    J[0, :3] = np.eye(3)
    axes = np.eye(3) if frame is None else frame
    return free_step(m * np.eye(3), force, contacts_of(phi, axes, J, mu_v), h)


def sphere_step(
    m: float,
    inertia: float,
    radius: float,
    wrench: ArrayLike,
    *,
    mu_v: float,
    mu_omega: float,
    phi: float,
    h: float,
) -> StepData:
    """A sphere over the floor z = 0, with torsion; wrench at its centre."""
    below = [[0.0, 0.0, -radius]]
    return rigid_step(
        m, inertia, wrench, below, [np.eye(3)],
        mu_v=mu_v, mu_omega=mu_omega, phi=phi, rows=6, h=h,
    )  # fmt: skip


def grid(*axes: Sequence[float] | Array) -> Array:
    """All combinations of some axes' values [any unit], shape (N, number of axes)."""
    return np.array(np.meshgrid(*axes, indexing="ij"), dtype=np.float64).reshape(len(axes), -1).T


def slope(x: ArrayLike, y: ArrayLike) -> float:
    """Exponent p of y = c x^p, fitted by least squares to the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def exact(step: StepData) -> StepSolution:
    """The step's optimum, exact and without any solver."""
    return solve_step(step, NONE)


def threshold(moves: Callable[[float], bool], low: float, high: float, precision: float) -> float:
    """Where a load begins to move something, by bisection.

    Parameters
    ----------
    moves : callable
        Whether a share of the load moves the body.
    low, high : float
        Shares [-]; where `low` moves already, or `high` does not yet, NaN is returned.
    precision : float
        Of the result, relative to `high` [-].

    Returns
    -------
    float
        A share [-].
    """
    if moves(low) or not moves(high):
        return float("nan")
    while high - low > precision * high:
        middle = (low + high) / 2
        low, high = (low, middle) if moves(middle) else (middle, high)
    return high
