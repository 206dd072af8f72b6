"""Signed distances of points to a solid shape, and the k closest of them.

A shape takes points in its own frame, shape (N, 3), and returns phi (N,) [m] and the unit outward
normal (N, 3): the gradient of phi. The closest point on the shape is then p - phi n. Where the
gradient is not unique (the centre of a sphere, a tie of two faces) the least index wins, so that
results are deterministic.

All shapes have closed forms but the ellipsoid, whose closest point is found by Newton's method, to
rounding. (Coal is right for sphere, box, capsule and half-space, and agrees with these functions to
1e-12; inside a cylinder coal's depth is wrong by up to millimetres.)
"""

import numpy as np

from quasistatic_ref.shapes.placed_shape import Shape
from quasistatic_ref.step.data import Array, Indices


def signed_distance(shape: Shape, points: Array) -> tuple[Array, Array]:
    """Signed distance and outward normal of points against one shape.

    Parameters
    ----------
    shape : Shape
        Any but a cloud.
    points : ndarray, shape (N, 3)
        In the shape's own frame [m].

    Returns
    -------
    phi : ndarray, shape (N,)
        Signed distance [m], negative inside.
    normal : ndarray, shape (N, 3)
        Unit normals, out of the shape.

    Raises
    ------
    ContactError
        If the shape is a cloud.
    """
    return shape.signed_distance(points)


def closest(phi: Array, k: int) -> Indices:
    """Indices of the k smallest signed distances in ascending order, ties broken by index.

    Parameters
    ----------
    phi : ndarray, shape (N,)
    k : int
        All of them if k >= N.

    Returns
    -------
    ndarray of int, shape (min(k, N),)
    """
    if k < len(phi):
        # Only what can be among the k smallest is sorted; every tie stays in the running.
        candidates = np.flatnonzero(~(phi > np.partition(phi, k - 1)[k - 1]))
    else:
        candidates = np.arange(len(phi))
    return candidates[np.argsort(phi[candidates], kind="stable")[:k]]
