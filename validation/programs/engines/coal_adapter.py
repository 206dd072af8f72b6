"""coal by itself: layer distance, with its default settings."""

from __future__ import annotations

from typing import Any

import coal
import numpy as np
from door import Unsupported, answer, rotation

NAME = f"coal {coal.__version__}"


def geometry(shape: Any) -> Any:
    """The shape, in coal's terms."""
    match shape["kind"]:
        case "sphere":
            return coal.Sphere(shape["radius"])
        case "box":
            return coal.Box(np.array(shape["size"]))
        case "capsule":
            return coal.Capsule(shape["radius"], shape["length"])
        case "cylinder":
            return coal.Cylinder(shape["radius"], shape["length"])
        case "cone":
            return coal.Cone(shape["radius"], shape["length"])
        case "ellipsoid":
            return coal.Ellipsoid(np.array(shape["half_axes"]))
        case "halfspace":
            length = np.linalg.norm(shape["normal"])
            return coal.Halfspace(np.array(shape["normal"]) / length, shape["offset"] / length)
        case "convex":
            points = coal.StdVec_Vec3s()
            points.extend([np.array(v) for v in shape["vertices"]])
            return coal.Convex.convexHull(points, True, "Qt")
        case kind:
            raise Unsupported(f"{kind} is no shape of coal")


def pair(case: Any) -> Any:
    """phi, alpha, beta, n of two solids."""
    placed = [
        coal.Transform3s(rotation(pose["quaternion"]), np.array(pose["xyz"]))
        for pose in (case["pose_alpha"], case["pose_beta"])
    ]
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    request.enable_signed_distance = True
    phi = coal.distance(
        geometry(case["alpha"]), placed[0], geometry(case["beta"]), placed[1], request, result
    )
    return phi, result.getNearestPoint1(), result.getNearestPoint2(), result.normal


def distance(case: Any) -> Any:
    """Layer 1; a cloud's points one by one, as spheres of radius zero."""
    for side in ("alpha", "beta"):
        if case[side]["kind"] == "cloud":
            R, t = rotation(case[f"pose_{side}"]["quaternion"]), case[f"pose_{side}"]["xyz"]
            each = [
                pair({**case, side: {"kind": "sphere", "radius": 0.0},
                      f"pose_{side}": {"xyz": R @ p + t, "quaternion": [0, 0, 0, 1]}})
                for p in np.array(case[side]["points"])
            ]  # fmt: skip
            phi, alpha, beta, n = (np.array(column) for column in zip(*each, strict=True))
            return {"phi": phi, "alpha": alpha, "beta": beta, "n": n}
    return dict(zip(("phi", "alpha", "beta", "n"), pair(case), strict=True))


if __name__ == "__main__":
    answer(NAME, {"distance": distance})
