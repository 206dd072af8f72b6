"""Meshes that are not convex: whether a mesh itself overlaps a shape, or its hull alone does."""

from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.contradictions import farthest_points
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Shape

FINEST: Final = 0.25
"""Radius of the smallest triangles that are looked at, over the depth that is asked for [-]."""


def hull_alone(start: Start, pair: ContactPair, depth: float) -> PlacedShape | None:
    """The side of an overlapping pair whose mesh stays clear of the other side, if there is one.

    Parameters
    ----------
    start : Start
    pair : ContactPair
    depth : float
        Up to which an overlap of the mesh is none [m].
    """
    R, t = start.kinematics.R, start.kinematics.t
    for side, other in ((pair.alpha, pair.beta), (pair.beta, pair.alpha)):
        shape = side.shape
        if isinstance(shape, ConvexMesh) and shape.surface is not None:
            in_link = shape.surface @ side.R.T + side.t
            in_world = in_link @ R[side.link].T + t[side.link]
            surface = ((in_world - t[other.link]) @ R[other.link] - other.t) @ other.R
            middle = (farthest_points(other).mean(axis=0) - other.t) @ other.R
            if not reaches(surface, other.shape, middle, depth):
                return side
    return None


def reaches(surface: Array, shape: Shape, middle: Array, depth: float) -> bool:
    """Whether a closed mesh and a shape have a point in common, deeper than `depth` in the shape.

    The signed distance to the shape changes by no more than the way. So a triangle whose middle is
    farther away than its radius is outside; others are divided in four.

    Parameters
    ----------
    surface : ndarray, shape (T, 3, 3)
        Corners of the mesh's triangles in the frame of the shape [m].
    shape : Shape
    middle : ndarray, shape (3,)
        A point inside of the shape, for a mesh around all of it [m].
    depth : float
        [m].
    """
    if isinstance(shape, PointCloud):
        return any(encloses(surface, point) for point in shape.points)
    near = surface
    while len(near):
        centres = near.mean(axis=1)
        radii = np.linalg.norm(near - centres[:, None], axis=2).max(axis=1)
        phi = shape.signed_distance(centres)[0]
        if (phi < -depth).any():
            return True
        near = near[(phi - radii < -depth) & (radii > FINEST * depth)]
        a, b, c = near.transpose(1, 0, 2)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        near = np.concatenate([np.stack(corners, axis=1) for corners in quarters])
    return encloses(surface, middle)


def encloses(surface: Array, point: Array) -> bool:
    """Whether a closed mesh winds around a point.

    The solid angles of its triangles add up to 4 pi inside and to 0 outside (van Oosterom and
    Strackee 1983).

    Parameters
    ----------
    surface : ndarray, shape (T, 3, 3)
        Corners of the mesh's triangles [m].
    point : ndarray, shape (3,)
        [m].
    """
    a, b, c = (surface - point).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    volume = np.sum(a * np.cross(b, c), axis=1)
    dots = np.sum(a * b, axis=1) * lc + np.sum(b * c, axis=1) * la + np.sum(c * a, axis=1) * lb
    return bool(abs(2 * np.arctan2(volume, la * lb * lc + dots).sum()) > 2 * np.pi)
