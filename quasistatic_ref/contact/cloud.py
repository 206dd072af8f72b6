"""Signed distances of points to solid shapes, vectorised, and the k closest of them.

Each ``distance_to_*`` takes points in the shape's own frame, shape (N, 3), and returns phi (N,)
[m] and the unit outward normal (N, 3): the gradient of phi. The closest point on the shape is
then p - phi n. Where the gradient is not unique (the centre of a sphere, a tie of two faces) the
least index wins, so that results are deterministic.

Closed forms, but for the ellipsoid (Newton's method, to rounding). (Coal is right for sphere, box,
capsule and half-space, and these agree with it to 1e-12; inside a cylinder its depth is wrong by up
to millimetres, ours is not.)
"""

import numpy as np

from quasistatic_ref.contact.curved import distance_to_cone, distance_to_ellipsoid
from quasistatic_ref.contact.hull import distance_to_hull, dot, norm
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model import shapes
from quasistatic_ref.model.convex_mesh import ConvexMesh
from quasistatic_ref.step.data import Array, Indices

Distance = tuple[Array, Array]
Rounded = shapes.Sphere | shapes.Capsule | shapes.Box
"""Sphere-swept shapes: the Minkowski sum of a point, segment or box with a ball."""
_AXES = np.eye(3)


def signed_distance(shape: shapes.Shape, points: Array) -> Distance:
    """Signed distance and outward normal of points against one shape.

    Parameters
    ----------
    shape : Sphere, Box, Cylinder, Capsule, Cone, Ellipsoid, HalfSpace or ConvexMesh
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
        If the shape is of another kind.
    """
    match shape:
        case shapes.Sphere() | shapes.Capsule() | shapes.Box():
            return distance_to_rounded_box(points, *rounded_box(shape))
        case shapes.Cylinder():
            return distance_to_cylinder(points, shape.radius, shape.half_length)
        case shapes.HalfSpace():
            phi = dot(points, shape.normal) - shape.offset
            return phi, np.broadcast_to(shape.normal, points.shape)
        case shapes.Ellipsoid():
            return distance_to_ellipsoid(points, shape.half_axes)
        case shapes.Cone():
            return distance_to_cone(points, shape.radius, shape.half_length)
        case ConvexMesh():
            return distance_to_hull(points, shape)
        case _:
            kind = type(shape).__name__
            raise ContactError("a cloud touches solid shapes only", field="shape", value=kind)


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


def rounded_box(shape: Rounded) -> tuple[Array, float]:
    """Half extents (3,) of a shape's core, a point, segment or cuboid, and the ball's radius."""
    if isinstance(shape, shapes.Box):
        return shape.half_extents, 0.0
    half_length = shape.half_length if isinstance(shape, shapes.Capsule) else 0.0
    return np.array([0.0, 0.0, half_length]), shape.radius


def distance_to_rounded_box(
    points: Array, half_extents: Array, radius: float | Array = 0.0
) -> Distance:
    """A cuboid, segment or point with a ball about each of its points: box, capsule, sphere.

    Outside the core by components, inside to the nearest face.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
    half_extents : ndarray, shape (3,) or (N, 3)
        One for all points, or one for each.
    radius : float or ndarray, shape (N,)
    """
    excess = np.abs(points) - half_extents  # > 0 beyond a face
    beyond = np.maximum(excess, 0.0)
    outside = norm(beyond)
    inside = np.maximum.reduce(excess, axis=-1)
    is_inside = outside == 0
    nearest_face = _AXES.take(excess.argmax(axis=-1), axis=1).T  # x before y before z, as beyond
    away = np.where(is_inside[..., None], nearest_face, beyond)
    away /= (outside + is_inside)[..., None]
    # Zero has the positive sign, whichever zero it is.
    normal = np.copysign(away, points + 0.0)
    return outside + np.minimum(inside, 0.0) - radius, normal


def distance_to_cylinder(points: Array, radius: float, half_length: float) -> Distance:
    """In the half-plane (r, |z|) a cylinder is a rectangle."""
    radial = points.copy()
    radial[:, 2] = 0.0
    r = norm(radial)
    outward = _unit(radial, r)
    excess = np.stack([r - radius, np.abs(points[:, 2]) - half_length], axis=1)
    beyond = np.maximum(excess, 0.0)
    outside = np.hypot(beyond[:, 0], beyond[:, 1])
    is_outside = outside > 0
    side = excess[:, 0] >= excess[:, 1]
    face = np.stack([side, ~side], axis=1).astype(np.float64)
    flat = beyond / np.where(is_outside, outside, 1.0)[:, None]
    weight = np.where(is_outside[:, None], flat, face)
    normal = weight[:, :1] * outward
    normal[:, 2] = weight[:, 1] * np.where(points[:, 2] < 0, -1.0, 1.0)
    return np.where(is_outside, outside, excess.max(axis=1)), normal


def _unit(vectors: Array, norms: Array) -> Array:
    """Unit vectors; the first axis where there is no direction."""
    degenerate = norms == 0
    unit = vectors / np.where(degenerate, 1.0, norms)[:, None]
    unit[degenerate] = (1.0, 0.0, 0.0)
    return unit
