"""Drake: distances by SceneGraph's signed distance of pairs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pydrake.all as drake
from door import Unsupported, rotation

SOLIDS = {
    "sphere": lambda s: drake.Sphere(s["radius"]),
    "box": lambda s: drake.Box(*s["size"]),
    "capsule": lambda s: drake.Capsule(s["radius"], s["length"]),
    "cylinder": lambda s: drake.Cylinder(s["radius"], s["length"]),
    "ellipsoid": lambda s: drake.Ellipsoid(*s["half_axes"]),
}


def placed(case: Any, side: str) -> tuple[Any, Any]:
    """A shape of Drake's and its pose; a half-space's z axis is its normal."""
    shape, pose = case[side], case[f"pose_{side}"]
    R, t = rotation(pose["quaternion"]), np.array(pose["xyz"])
    if shape["kind"] == "halfspace":
        normal = np.array(shape["normal"])
        length = np.linalg.norm(normal)
        inside = drake.HalfSpace.MakePose(normal / length, normal * shape["offset"] / length**2)
        return drake.HalfSpace(), drake.RigidTransform(drake.RotationMatrix(R), t) @ inside
    if shape["kind"] not in SOLIDS:
        raise Unsupported(f"the adapter does not ask for a {shape['kind']}")
    return SOLIDS[shape["kind"]](shape), drake.RigidTransform(drake.RotationMatrix(R), t)


def distance(case: Any) -> Any:
    """Layer 1."""
    graph = drake.SceneGraph()
    source, frames, poses = graph.RegisterSource("case"), [], drake.FramePoseVector()
    numbers = []
    for side in ("alpha", "beta"):
        solid, X = placed(case, side)
        frame = drake.GeometryFrame(side)
        frames.append(graph.RegisterFrame(source, frame))
        instance = drake.GeometryInstance(drake.RigidTransform(), solid, side)
        instance.set_proximity_properties(drake.ProximityProperties())
        numbers.append(graph.RegisterGeometry(source, frames[-1], instance))
        poses.set_value(frames[-1], X)
    context = graph.CreateDefaultContext()
    graph.get_source_pose_port(source).FixValue(context, poses)
    query = graph.get_query_output_port().Eval(context)
    try:
        near = query.ComputeSignedDistancePairClosestPoints(*numbers)
    except RuntimeError as error:
        raise Unsupported(str(error)[:80]) from None
    alpha, beta = (
        poses.value(frame) @ np.asarray(point)
        for frame, point in zip(frames, (near.p_ACa, near.p_BCb), strict=True)
    )
    return {"phi": near.distance, "alpha": alpha, "beta": beta, "n": -near.nhat_BA_W}
