"""Directions in which one convex solid leaves another by the shortest way.

In penetration the gap s(n) has several local maxima, and coal's expanding polytope stops at any
of them, up to the size of the solids away from the best. So the search starts from many
directions: a spread over the sphere, and those in which maxima are sharp.
"""

from functools import cache

import numpy as np

from quasistatic_ref.contact.normals import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.optional.curved.measured_by_coal import MeasuredByCoal

SPREAD = 1024
"""Directions over the sphere, about 0.11 rad apart: no direction is farther than REACH from one."""

REACH = 0.086
"""[rad]; the largest hole, near a pole, has a radius of 0.0853."""

STARTS = 6
"""Local maxima that are followed at most."""

NEAR = np.cos(0.2)
"""Cosine above which a direction is a neighbour of another."""

APART = 0.985
"""Cosine above which two directions are taken to lead to the same maximum."""


def rival_directions(
    a: ShapeInWorld, b: ShapeInWorld, first: Array, phi: float, size: float
) -> list[Array]:
    """Directions of other local maxima of the gap, near which it may exceed phi.

    Parameters
    ----------
    a, b : ShapeInWorld
    first : ndarray, shape (3,)
        The known direction, a unit vector in the world frame [-].
    phi : float
        The gap along it [m].
    size : float
        By how much a gap can change per radian [m].

    Returns
    -------
    list of ndarray, shape (3,)
        At most STARTS, the widest gap first.
    """
    sharp = np.concatenate([sharp_directions(a), -sharp_directions(b)])
    sphere, neighbours = _sphere()
    spread_gaps = gaps(a, b, sphere)
    sharp_gaps = gaps(a, b, sharp)
    peaks = (spread_gaps[neighbours] <= spread_gaps[:, None]).all(axis=1)
    near = sharp @ sphere.T > NEAR
    sharp_peaks = (np.where(near, spread_gaps, -np.inf) <= sharp_gaps[:, None]).all(axis=1)
    directions = np.concatenate([sphere[peaks], sharp[sharp_peaks]])
    peak_gaps = np.concatenate([spread_gaps[peaks], sharp_gaps[sharp_peaks]])
    chosen = [first]
    for k in np.argsort(-peak_gaps, kind="stable"):
        if peak_gaps[k] <= phi - REACH * size or len(chosen) > STARTS:
            break
        if all(directions[k] @ other < APART for other in chosen):
            chosen.append(directions[k])
    return chosen[1:]


def sharp_directions(solid: ShapeInWorld) -> Array:
    """Normals of the faces, or the axes of a curved solid, in the world frame, shape (N, 3)."""
    flat = polytope(solid.shape)
    normals = np.concatenate([np.eye(3), -np.eye(3)]) if flat is None else flat.normals
    return normals @ solid.R.T


def known_gaps(a: ShapeInWorld, b: ShapeInWorld, nearest: Witness) -> tuple[Array, Array]:
    """Gaps, (N,) [m], along the normals (N, 3) of faces at the closest points, and along axes.

    Parameters
    ----------
    a, b : ShapeInWorld
    nearest : Witness
        Their closest points.
    """
    if isinstance(a.shape, MeasuredByCoal):  # of axes that are apart: no other normal is as near
        return np.zeros(0), np.zeros((0, 3))
    ways = [sharp_directions(a), -sharp_directions(b)]
    for solid, end, sign in ((a, nearest.alpha, 1.0), (b, nearest.beta, -1.0)):
        _, normals = solid.shape.faces(product(end - solid.t, solid.R)[None])
        ways.append(sign * product(normals[0], solid.R.T))
    every = np.concatenate(ways)
    return gaps(a._replace(t=a.t - b.t), b._replace(t=0 * b.t), every), every


@cache
def _sphere() -> tuple[Array, Indices]:
    """Directions spread evenly over the sphere, on a Fibonacci spiral, and neighbours of each."""
    k = np.arange(SPREAD) + 0.5
    z = 1 - 2 * k / SPREAD
    turn = np.pi * (1 + np.sqrt(5)) * k
    r = np.sqrt(1 - z * z)
    sphere = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
    return sphere, np.argsort(-(sphere @ sphere.T), axis=1, kind="stable")[:, 1:9]
