"""How many points a body needs to lie on, in each way in which it can lie."""

from bisect import bisect_left
from functools import partial

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.numbers.arrays import Array

FEWEST = 4
"""Fewest contacts that are suggested: corners of a face."""
FLAT = 1e-7
"""Points of a face are equally low to so much of the extent [-]."""
DECIMALS = 7
"""Decimals of normals to which faces are the same."""


def points_to_lie_on(points: Array, centre: Array) -> tuple[int, int, Array]:
    """The least k with which a cloud stands still in each way it can lie, and how many ways.

    The third value is the outward normal of the face, shape (3,), that it is hardest to tip from.

    It can lie on a face of its hull if the centre of mass is over that face. The k lowest points,
    of equally low ones the first, must then be around the centre as well.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Not all in a plane [m].
    centre : ndarray, shape (3,)
        Of mass [m].
    """
    extent = np.ptp(points, axis=0).max()
    points, centre = points / extent, centre / extent
    faces = ConvexHull(points).equations
    rounded, first = np.unique(faces.round(DECIMALS), axis=0, return_index=True)
    d1, d2 = tangents(faces[first, :3])
    needed = []
    stable = []
    for face, normal, along, across in zip(first, rounded[:, :3], d1, d2, strict=True):
        below = points @ faces[face, :3]
        low = below > below.max() - FLAT
        flat = (points - centre) @ np.stack([along, across], axis=1)
        if not _around(flat[low]):
            continue
        flat = flat[np.argsort(-np.where(low, np.inf, below), kind="stable")]
        counts = range(3, len(points))
        count = 3 + bisect_left(counts, True, key=partial(_lowest_are_around, flat))
        needed.append(count)
        # The tangent of the angle at which it tips; of equal ones, rather as it was scanned.
        edges = ConvexHull(flat[:count]).equations[:, 2]
        tips = float(-edges.max() / (below.max() - centre @ normal))
        stable.append((round(tips, 6), -normal[2], *(normal + 0.0).tolist()))
    return max([FEWEST, *needed]), len(needed), np.array(max(stable)[2:])


def _lowest_are_around(flat: Array, count: int) -> bool:
    """Whether the first `count` of points in the plane, shape (N, 2), are around the origin."""
    return _around(flat[:count])


def _around(flat: Array) -> bool:
    """Whether points of a plane, shape (N, 2), lie around the origin."""
    angles = np.sort(np.arctan2(flat[:, 1], flat[:, 0]))
    return len(flat) > 2 and bool(np.diff(angles, append=angles[0] + 2 * np.pi).max() < np.pi)
