"""Shapes of the vectors as the package knows them, and its own closest points."""

from typing import Any

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import PointCloud, Shape


def own_shape(shape: dict[str, Any]) -> Shape:
    """The package's shape for a shape of a case; InputError if the package has none."""
    match shape["kind"]:
        case "sphere":
            return shapes.Sphere(shape["radius"])
        case "box":
            return shapes.Box(np.array(shape["size"]) / 2)
        case "capsule":
            return shapes.Capsule(shape["radius"], shape["length"] / 2)
        case "cylinder":
            return shapes.Cylinder(shape["radius"], shape["length"] / 2)
        case "cone":
            return shapes.Cone(shape["radius"], shape["length"] / 2)
        case "ellipsoid":
            return shapes.Ellipsoid(np.array(shape["half_axes"]))
        case "halfspace":
            return shapes.HalfSpace(np.array(shape["normal"]), shape["offset"])
        case "convex":
            return convex_hull(shape["vertices"])
        case "cloud":
            return PointCloud(np.array(shape["points"]))
        case _:
            raise InputError("must be a kind of shape", field="shape.kind", value=shape["kind"])


def own_shape_in_world(case: dict[str, Any], side: str) -> ShapeInWorld:
    """The shape of a case that is its ``"alpha"`` or its ``"beta"``."""
    pose = case[f"pose_{side}"]
    return ShapeInWorld(own_shape(case[side]), rotation(pose["quaternion"]), np.array(pose["xyz"]))


def own_closest_points(case: dict[str, Any]) -> dict[str, Any]:
    """phi, alpha, beta, n of a case; of a cloud, lists over its points."""
    a = own_shape_in_world(case, "alpha")
    b = own_shape_in_world(case, "beta")
    if isinstance(b.shape, PointCloud):
        phi, foot, point, n = _points_on_solid(a, b, b.shape.points)
        points = {"phi": phi, "alpha": foot, "beta": point, "n": n}
    elif isinstance(a.shape, PointCloud):
        phi, foot, point, n = _points_on_solid(b, a, a.shape.points)
        points = {"phi": phi, "alpha": point, "beta": foot, "n": -n}
    else:
        points = {key: np.asarray(x) for key, x in solid_pair("pair", a, b)._asdict().items()}
    return {key: (value + 0.0).tolist() for key, value in points.items()}


def _points_on_solid(
    solid: ShapeInWorld, cloud: ShapeInWorld, points: Array
) -> tuple[Array, Array, Array, Array]:
    """Distances, closest points of the solid, the points themselves and normals, world frame."""
    world = points @ cloud.R.T + cloud.t
    phi, normal = solid.shape.signed_distance((world - solid.t) @ solid.R)
    n = normal @ solid.R.T
    return phi, world - phi[:, None] * n, world, n
