r"""What a shape is about a point of its surface: a vertex, an edge, a face, or curved.

Where the outward normal turns by r, the farthest point along it moves by :math:`D r`, the Hessian
of the shape's reach (zero at a vertex, the radius of a sphere). Along some directions F the
surface is straight: there the normal cannot turn, and the point moves freely. So

.. math:: p = D r + F z, \qquad F^T r = 0

is one relation for all of them, and each shape supplies D and F. A rim is an edge that bends: along
it, D would be its radius over the radial part of the normal, and F'r is z over that. Where the
point is on the rim of its face or edge, or the normal on the rim of those that its edge or vertex
has, the relation is another on each side: those directions are the feature's `ends`.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.solids.polytope import Polytope, polytope
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.tolerances import LEVEL
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Shape,
    Sphere,
)
from quasistatic_ref.tolerances import ON_RIM

NONE = np.zeros((0, 3))
STRAIGHT = np.zeros((3, 3))
"""D of what does not bend."""


class Feature(NamedTuple):
    """The relation of point and normal, in one frame.

    Parameters
    ----------
    bend : ndarray, shape (3, 3)
        D [m].
    free : ndarray, shape (k, 3)
        F: k unit vectors across the normal, k = 0, 1 or 2 [-].
    ends : ndarray, shape (e, 3)
        Directions in which another feature begins [-].
    arc : ndarray, shape (0 or 1, 3)
        The direction of a rim, in which the surface is nearly straight where its normal is nearly
        the axis [-]: not in `bend`, in which numbers that large hide the others.
    curvature : float
        Along it, 0 if it were straight [1/m].
    """

    bend: Array = STRAIGHT
    free: Array = NONE
    ends: Array = NONE
    arc: Array = NONE
    curvature: float = 0.0

    @property
    def merged(self) -> "Feature":
        """The same with the directions in which it ends as free ones."""
        if not len(self.ends):
            return self
        _, s, V = np.linalg.svd(np.concatenate([self.free, self.ends]))
        return Feature(self.bend, V[: len(s)][s > ON_RIM][:2])

    def turned(self, R: Array) -> "Feature":
        """The same in another frame, R of shape (3, 3) [-] from this frame to that."""
        free, ends, arc = (
            some @ R.T if len(some) else some for some in (self.free, self.ends, self.arc)
        )
        return Feature(R @ self.bend @ R.T, free, ends, arc, self.curvature)


def ball(radius: float, n: Array) -> Feature:
    """A sphere's [m], or of radius 0 a vertex's, whose outward normal is n of shape (3,) [-]."""
    if not radius:
        return Feature()
    return Feature(radius * (np.eye(3) - np.outer(n, n)))


def feature(shape: Shape, x: Array, n: Array) -> Feature:
    """The feature of a shape at a point of its surface, in the shape's own frame.

    Parameters
    ----------
    shape : any shape
    x, n : ndarray, shape (3,)
        Point [m] and outward normal [-].

    Raises
    ------
    ContactError
        If the shape has no derivatives.
    """
    match shape:
        case Sphere():
            return ball(shape.radius, n)
        case HalfSpace():
            return Feature(free=across(n))
        case Capsule():
            return _of_capsule(shape, x, n)
        case Cylinder():
            return _of_revolved(shape, 0.0, x, n)
        case Cone():
            return _of_revolved(shape, shape.radius, x, n)
        case Ellipsoid():
            return Feature(shape.curvature(n))
        case Box() | ConvexMesh():
            flat = polytope(shape)
            assert flat is not None
            return _of_polytope(flat, x, n, ON_RIM * shape.extent)
        case _:
            raise shape.lacks("has no derivatives")


def _of_capsule(shape: Capsule, x: Array, n: Array) -> Feature:
    axis = np.array([[0.0, 0.0, 1.0]])
    height = abs(x[2] - shape.radius * n[2])  # of the point of the segment
    bend = ball(shape.radius, n).bend
    if height < shape.half_length - ON_RIM * (shape.half_length + shape.radius):
        return Feature(bend, axis)
    return Feature(bend, ends=axis if abs(n[2]) <= ON_RIM else NONE)


def _of_revolved(shape: Cylinder | Cone, taper: float, x: Array, n: Array) -> Feature:
    """Of a cylinder, or of a cone: its top is narrower than its base by `taper` [m]."""
    near = ON_RIM * (shape.radius + shape.half_length)
    slant = np.hypot(taper, 2 * shape.half_length)
    level = taper / slant  # of the side's normal
    outward = n[:2] / (np.hypot(*n[:2]) or 1.0)
    generator = np.array([[*(-level * outward), 2 * shape.half_length / slant]])
    on_side = generator if abs(n[2] - level) <= ON_RIM else NONE
    at_top = x[2] >= shape.half_length - near
    if x[2] <= -shape.half_length + near or (at_top and not taper):
        if np.hypot(*x[:2]) < shape.radius - near:
            return Feature(free=across(n))
        return _of_rim(x, n, on_side)
    if at_top:
        return Feature(ends=on_side)
    return Feature(_around(x, n), generator)


def _of_polytope(flat: Polytope, x: Array, n: Array, near: float) -> Feature:
    """Of the faces that meet at x: one is a face, two an edge, and more a vertex."""
    level = flat.normals @ x - flat.offsets
    on = flat.normals[level >= level.max() - near]
    if len(on) == 1:
        return Feature(free=across(n))
    if len(on) == 2:
        along = np.cross(on[0], on[1])
        shares = np.linalg.lstsq(on.T, n, rcond=None)[0]
        along = along / np.sqrt(along @ along)
        side = np.cross(along, n)[None]
        return Feature(free=along[None], ends=side if shares.min() <= ON_RIM else NONE)
    tail = flat.vertices[flat.edges[:, 0]]
    head = flat.vertices[flat.edges[:, 1]]
    here = [np.abs(end - x).max(axis=1) <= 10 * near for end in (tail, head)]
    ways = np.concatenate([(head - tail)[here[0]], (tail - head)[here[1]]])
    ways = ways / np.sqrt(np.sum(ways * ways, axis=1))[:, None]
    return Feature(ends=ways[ways @ n >= -ON_RIM])


def _of_rim(x: Array, n: Array, side: Array) -> Feature:
    """Of a circle about the z axis; `side` (0 or 1, 3) is the way to the side where it begins."""
    radial = np.hypot(n[0], n[1])
    if radial <= LEVEL:
        return Feature(ends=across(n))
    if len(side):
        return Feature(_around(x, n), ends=side)
    return Feature(arc=_way_around(x)[None], curvature=float(radial / np.hypot(*x[:2])))


def _around(x: Array, n: Array) -> Array:
    """D of the circle about the z axis through x, where its normal is n."""
    around = _way_around(x)
    radial = np.hypot(n[0], n[1]) or np.inf
    return np.asarray(np.hypot(x[0], x[1]) / radial * np.outer(around, around))


def _way_around(x: Array) -> Array:
    """From x, not from a normal: near the axis that knows its direction to fewer digits."""
    return np.array([-x[1], x[0], 0.0]) / (np.hypot(x[0], x[1]) or 1.0)


def across(n: Array) -> Array:
    """Two unit vectors across a unit vector n (3,) [-], shape (2, 3)."""
    return np.linalg.svd(n[None])[2][1:]
