"""What a convex solid has farthest along a direction: a point, a segment, a disc or a polygon.

The reach h(n) = max n . x of a solid is smooth where one point is farthest, with gradient p(n),
that point, and Hessian D(n). It has a kink where more than one is: along the circle n . u = c of
the normals of an edge, a side or a slant, and at the one normal of a flat face.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cone, Cylinder, Ellipsoid, Shape

FLAT = 1e-11
"""Deviation [rad], or of lengths relative to the solid, at which a normal is that of a face."""


class Kinks(NamedTuple):
    """Where the reach of a solid has kinks.

    Parameters
    ----------
    axes : ndarray, shape (K, 3)
        Unit vectors u of circles n . u = c [-].
    levels : ndarray, shape (K,)
        Their c [-].
    normals : ndarray, shape (F, 3)
        Outward unit normals of flat faces [-].
    """

    axes: Array
    levels: Array
    normals: Array

    def near(self, n: Array, within: float) -> "Kinks":
        """The kinks whose directions lie near a given one.

        Parameters
        ----------
        n : ndarray, shape (3,)
            Unit vector in the solid's own frame [-].
        within : float
            Largest deviation, about [rad].
        """
        circle = np.abs(self.axes @ n - self.levels) < within
        face = np.sum((self.normals - n) ** 2, axis=1) < within**2
        return Kinks(self.axes[circle], self.levels[circle], self.normals[face])


@lru_cache(maxsize=256)
def kinks(shape: Shape) -> Kinks:
    """The kinks of a solid in its own frame.

    Parameters
    ----------
    shape : any bounded solid other than a sphere

    Raises
    ------
    ContactError
        If its faces are not known.
    """
    z = np.array([[0.0, 0.0, 1.0]])
    none = np.zeros((0, 3))
    match shape:
        case Ellipsoid():
            return Kinks(none, np.zeros(0), none)
        case Capsule():
            return Kinks(z, np.zeros(1), none)
        case Cylinder():
            return Kinks(z, np.zeros(1), np.concatenate([z, -z]))
        case Cone():
            slant = np.hypot(shape.radius, 2 * shape.half_length)
            return Kinks(z, np.array([shape.radius / slant]), -z)
    flat = polytope(shape)
    if flat is None:
        raise shape.lacks("known faces", "another solid", "them into optional/curved/faces.py")
    ways = flat.ways
    ways = ways / np.sqrt(np.sum(ways * ways, axis=1))[:, None]
    return Kinks(ways, np.zeros(len(ways)), flat.normals)


def placed_kinks(solid: ShapeInWorld, n: Array, within: float) -> Kinks:
    """The kinks near a direction, in the world frame.

    Parameters
    ----------
    solid : ShapeInWorld
        Bounded, and no sphere.
    n : ndarray, shape (3,)
        Unit vector in the world frame [-].
    within : float
        Largest deviation, about [rad].
    """
    near = kinks(solid.shape).near(solid.R.T @ n, within)
    return near._replace(axes=near.axes @ solid.R.T, normals=near.normals @ solid.R.T)


def curvature(solid: ShapeInWorld, n: Array) -> Array:
    """D(n), the Hessian of the reach where it is smooth, shape (3, 3) [m], world frame.

    Parameters
    ----------
    solid : ShapeInWorld
        Bounded, and no sphere.
    n : ndarray, shape (3,)
        Unit vector in the world frame [-].
    """
    shape = solid.shape
    local = solid.R.T @ n
    match shape:
        case Ellipsoid():
            D = shape.curvature(local)
        case Capsule():
            D = shape.radius * (np.eye(3) - np.outer(local, local))
        case Cylinder() | Cone():
            radial = np.hypot(local[0], local[1])
            # Of a cone the very point that is taken for farthest decides, not another rounding.
            on_rim = isinstance(shape, Cylinder) or shape.support_point(local)[2] < 0
            around = np.array([-local[1], local[0], 0.0]) / (radial or 1.0)
            D = shape.radius * on_rim / (radial or np.inf) * np.outer(around, around)
        case _:
            return np.zeros((3, 3))
    return np.asarray(solid.R @ D @ solid.R.T)


class Face(NamedTuple):
    """All points of a solid that are farthest along a direction, in the world frame.

    Parameters
    ----------
    corners : ndarray, shape (V, 3)
        A point, the ends of a segment, or the corners of a polygon in order [m].
    radius : float
        Of a disc about the only corner, or 0 [m].
    n : ndarray, shape (3,)
        The direction [-].
    """

    corners: Array
    radius: float
    n: Array

    def nearest(self, x: Array) -> Array:
        """The face's point nearest to the line through x along n, shape (3,) [m].

        Parameters
        ----------
        x : ndarray, shape (3,)
            [m].
        """
        first = self.corners[0]
        away = x - first
        away = away - (away @ self.n) * self.n
        if len(self.corners) == 1:
            length = np.sqrt(away @ away)
            return np.asarray(first + away * (min(1.0, self.radius / length) if length else 0.0))
        x = first + away
        ways = np.roll(self.corners, -1, axis=0) - self.corners
        if len(self.corners) > 2:
            inside = crossed(ways, x - self.corners) @ self.n
            if (inside >= 0).all():
                return np.asarray(x)
        share = np.sum((x - self.corners) * ways, axis=1) / np.sum(ways * ways, axis=1)
        points = self.corners + np.clip(share, 0.0, 1.0)[:, None] * ways
        return np.asarray(points[np.sum((points - x) ** 2, axis=1).argmin()])


def face(solid: ShapeInWorld, n: Array) -> Face:
    """The face of a solid along a direction: all of its points that are farthest.

    Parameters
    ----------
    solid : ShapeInWorld
        Bounded, and no sphere.
    n : ndarray, shape (3,)
        Unit vector in the world frame [-].
    """
    shape = solid.shape
    local = solid.R.T @ n
    corners = solid.farthest(n)[None]
    radius = 0.0
    match shape:
        case Cylinder() | Cone() if kinks(shape).near(local, FLAT).normals.size:
            corners = solid.t[None] + np.sign(local[2]) * shape.half_length * solid.R[None, :, 2]
            radius = shape.radius
        case Capsule() | Cylinder() if abs(local[2]) <= FLAT:
            half = shape.half_length * solid.R[:, 2]
            middle = solid.t + shape.radius * (n - local[2] * solid.R[:, 2])
            corners = np.stack([middle - half, middle + half])
        case Cone() if abs(local[2] - kinks(shape).levels[0]) <= FLAT:
            tip = shape.half_length * solid.R[:, 2]
            level = n - local[2] * solid.R[:, 2]
            rim = shape.radius * level / np.sqrt(level @ level) - tip
            corners = solid.t + np.stack([rim, tip])
        case Box() | ConvexMesh():
            corners = _polygon(solid, n)
    return Face(corners, radius, n)


def _polygon(solid: ShapeInWorld, n: Array) -> Array:
    """The farthest corners of a polytope, in counter-clockwise order about n."""
    flat = polytope(solid.shape)
    assert flat is not None
    vertices = flat.vertices @ solid.R.T
    height = vertices @ n
    top = vertices[height >= height.max() - FLAT * np.abs(vertices).max()]
    if len(top) > 2:
        across = top - top.mean(axis=0)
        e1 = across[np.sum(across * across, axis=1).argmax()]
        e2 = crossed(n[None], e1[None])[0]
        top = top[np.arctan2(across @ e2, across @ e1).argsort()]
    return np.asarray(top + solid.t)
