"""Contacts from plain arrays: frames, J of points of a rigid body, some of them picked."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import Contacts

X, Y, Z = np.eye(3)

GRAVITY = 9.81
"""Acceleration of free fall in every scene of this folder [m/s^2]."""

NUMBERS = ("phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
"""The fields of contacts that have one entry for each."""


def contacts_of(
    phi: ArrayLike,
    frames: ArrayLike,
    J: ArrayLike,
    mu_v: ArrayLike,
    mu_omega: ArrayLike = 0.0,
    rows: ArrayLike = 4,
) -> Contacts:
    """Contacts c0, c1, ... from frames and J.

    Parameters
    ----------
    phi, mu_v, mu_omega, rows : array_like, shape () or (n_c,)
        Those of the notation, for all contacts or one for each.
    frames : array_like, shape (n_c, 3, 3)
        Rows d1, d2, n.
    J : array_like, shape (n_c, 4, n_v)
    """
    J = np.asarray(J, dtype=np.float64)
    n_c = len(J)
    frames = np.asarray(frames, dtype=np.float64).reshape(n_c, 3, 3)
    return Contacts(
        name=tuple(f"c{j}" for j in range(n_c)),
        phi=np.broadcast_to(phi, n_c),
        n=frames[:, 2],
        d1=frames[:, 0],
        d2=frames[:, 1],
        J=J,
        mu_v=np.broadcast_to(mu_v, n_c),
        mu_omega=np.broadcast_to(mu_omega, n_c),
        rows=np.broadcast_to(rows, n_c),
    )


def no_contacts(n_v: int) -> Contacts:
    """A `Contacts` of no contact, between bodies of n_v coordinates."""
    return contacts_of((), (), np.zeros((0, 4, n_v)), (), (), ())


def repeated(every: Contacts, index: Any, **changes: Any) -> Contacts:
    """Contacts of the given numbers, repeated as the numbers are, with changed fields."""
    fields = {key: getattr(every, key)[np.asarray(index, dtype=int)] for key in NUMBERS} | changes
    return Contacts(name=tuple(f"c{j}" for j in range(len(index))), **fields)


def frames_about(n: Array, across: Array) -> Array:
    """Frames [d1, d2, n] with d1 along across x n, shape (n_c, 3, 3).

    Parameters
    ----------
    n : ndarray, shape (n_c, 3)
        Unit vectors.
    across : ndarray, shape (3,)
        Any length [-], along none of them.
    """
    d1 = np.cross(across, n)
    d1 /= np.linalg.norm(d1, axis=1, keepdims=True)
    return np.stack([d1, np.cross(n, d1), n], axis=1)


def point_jacobian(points: ArrayLike, n: ArrayLike) -> Array:
    """J of Eq. :eq:`eq-3` of points of one body against the world, per unit of the body's twist.

    Parameters
    ----------
    points : array_like, shape (..., 3)
        From the origin of the twist, along its axes [m].
    n : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 4, 6)
    """
    points = np.asarray(points, dtype=np.float64)
    J = np.zeros((*points.shape[:-1], 4, 6))
    J[..., :3, :3] = np.eye(3)
    J[..., :3, 3:] = np.cross(np.eye(3), points[..., None, :]).swapaxes(-1, -2)  # omega x r
    J[..., 3, 3:] = n
    return J
