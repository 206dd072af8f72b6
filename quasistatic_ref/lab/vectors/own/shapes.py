"""Shapes of the vectors as the package knows them, and its own closest points."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Shape
from quasistatic_ref.step.data import Array


def own_shape(shape: dict[str, Any]) -> Shape:
    """The package's shape; InputError if it has none such."""
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
            raise InputError("is not a kind of shape", field="shape.kind", value=shape["kind"])


def own_rotation(quaternion: Sequence[float]) -> Array:
    """Rotation matrix (3, 3) of a quaternion of any length."""
    x, y, z, w = np.array(quaternion) / np.hypot.reduce(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def own_closest_points(case: dict[str, Any]) -> dict[str, Any]:
    """phi, alpha, beta, n of a case; of a cloud, lists over its points."""
    poses = [case["pose_alpha"], case["pose_beta"]]
    solids = [own_shape(case["alpha"]), own_shape(case["beta"])]
    clouds = [shape for shape in solids if isinstance(shape, PointCloud)]
    alpha, beta = (
        PlacedShape(name, link, np.eye(3), np.zeros(3), shape)
        for link, (name, shape) in enumerate(zip(("alpha", "beta"), solids, strict=True))
    )
    k = len(clouds[0].points) if clouds else 1
    pair = ContactPair("pair", alpha, beta, 0.0, 0.0, 4, k)
    kinematics = Kinematics(
        np.stack([own_rotation(pose["quaternion"]) for pose in poses]),
        np.array([pose["xyz"] for pose in poses], dtype=np.float64),
        np.zeros((2, 6, 0)),
    )
    found = closest_points([pair], kinematics)
    # A pair sorts its contacts by distance; here they are in the order of the points.
    order = np.argsort(found.point) if clouds else np.array([0])
    answer = {
        key: (getattr(found, key)[order] + 0.0).tolist() for key in ("phi", "alpha", "beta", "n")
    }
    return answer if clouds else {key: value[0] for key, value in answer.items()}
