"""A scenario's bodies and shapes as the tables of a case: no URDF, no file is needed any more.

Numbers are those of the URDFs in float64, rotations as quaternions; a case is what it says, and
need not be the scenario to the last bit.
"""

from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.program.rotation import quaternion_of
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.mechanisms import ORIGIN, at
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.model.urdf.urdf_file import FileLink, UrdfFile, urdf_file
from quasistatic_ref.model.urdf.urdf_tree import FileJoint
from quasistatic_ref.model.world import world_of
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape, Shape
from quasistatic_ref.step.data import Array


def mechanism_of(scenario: Scenario) -> Json:
    """The bodies of a scenario, so that q and delta_q keep their order."""
    bodies: list[Json] = []
    for entry in scenario.bodies.values():
        bodies += _tree(entry.body, urdf_file(entry.body.urdf))
    by_name = {body["name"]: body for body in bodies}
    # Among the actuated and among the others the order of pinocchio counts.
    joints = {joint.name: joint.v.start for joint in world_of(scenario.system.bodies).joints}
    moving = [body for body in bodies if body["joint"] != "fixed" and "mimic" not in body]
    ordered: list[Json] = []
    for body in [*sorted(moving, key=lambda body: joints[body["of"]]), *bodies]:
        chain = [body]
        while chain[-1]["parent"] is not None:
            chain.append(by_name[chain[-1]["parent"]])
        ordered += [link for link in reversed(chain) if link not in ordered]
    return {"bodies": [{k: v for k, v in body.items() if k != "of"} for body in ordered]}


def pairs_of(scenario: Scenario) -> tuple[Json, Json]:
    """The shapes that may touch, by name, and the pairs that they make."""
    shapes: dict[str, Json] = {}
    pairs = []
    for pair in scenario.pairs:
        for side in (pair.alpha, pair.beta):
            shapes[side.name] = _shape(side, scenario)
        pairs.append(_pair(pair))
    return shapes, pairs


def shape_of(shape: Shape) -> Json:
    """The table of a shape; ContactError if the cases have none such."""
    match shape:
        case shapes.Sphere():
            return {"kind": "sphere", "radius": shape.radius}
        case shapes.Box():
            return {"kind": "box", "size": (2 * shape.half_extents).tolist()}
        case shapes.Capsule() | shapes.Cylinder() | shapes.Cone():
            kind = type(shape).__name__.lower()
            return {"kind": kind, "radius": shape.radius, "length": 2 * shape.half_length}
        case shapes.Ellipsoid():
            return {"kind": "ellipsoid", "half_axes": shape.half_axes.tolist()}
        case shapes.HalfSpace():
            return {"kind": "halfspace", "normal": shape.normal.tolist(), "offset": shape.offset}
        case ConvexMesh():
            return {"kind": "convex", "vertices": shape.vertices.tolist()}
        case shapes.PointCloud():
            return {"kind": "cloud", "points": shape.points.tolist()}
        case _:
            raise shape.lacks("has no kind in the cases")


def pose_of(R: Array, t: Array) -> Json:
    """A pose as position and quaternion, its largest entry positive."""
    return {"xyz": (t + 0.0).tolist(), "quaternion": (quaternion_of(R) + 0.0).tolist()}


def _tree(body: Body, file: UrdfFile) -> list[Json]:
    place, kind = _base(body)
    links = [_link(body.name, file.links[file.root], None, place, kind, f"{body.name}/base")]
    links[0]["actuated"] = _actuated(body, "base") and kind != "fixed"
    carried = {joint.name: f"{body.name}/{joint.child}" for joint in file.joints}
    for joint in file.joints:
        entry = _link(
            body.name,
            file.links[joint.child],
            f"{body.name}/{joint.parent}",
            pose_of(joint.R, joint.t),
            joint.kind,
            f"{body.name}/{joint.name}",
        )
        links.append({**entry, **_moves(body, joint, carried)})
    return links


def _base(body: Body) -> tuple[Json, str]:
    if body.base == "floating":
        return ORIGIN, "floating"
    xyz = np.asarray(body.xyz)
    if body.base == "planar":
        return at(0.0, 0.0, float(xyz[2])), "planar"
    return {"xyz": xyz.tolist(), "quaternion": quaternion(np.asarray(body.rpy)).tolist()}, "fixed"


def _link(
    body: str, link: FileLink, parent: str | None, place: Json, kind: str, of: str
) -> dict[str, Any]:
    entry = {
        "name": f"{body}/{link.name}",
        "parent": parent,
        "placement": place,
        "joint": kind,
        "axis": [0.0, 0.0, 1.0],
        "actuated": False,
        "of": of,
    }
    if link.mass:
        entry |= {"mass": link.mass, "com": link.com.tolist(), "inertia": link.inertia.tolist()}
    return entry


def _moves(body: Body, joint: FileJoint, carried: dict[str, str]) -> dict[str, Any]:
    if joint.kind == "fixed":
        return {}
    axis = {"axis": joint.axis.tolist()}
    if joint.mimic is None:
        return {**axis, "actuated": _actuated(body, joint.name)}
    of = carried[joint.mimic.of]
    multiplier = joint.mimic.multiplier
    offset = joint.mimic.offset
    actuated = _actuated(body, joint.mimic.of)
    follow = {"of": of, "multiplier": multiplier, "offset": offset}
    return {**axis, "actuated": actuated, "mimic": follow}


def _actuated(body: Body, joint: str) -> bool:
    return body.actuated == "all" or joint in body.actuated


def _shape(side: PlacedShape, scenario: Scenario) -> Json:
    link = scenario.system.links[side.link]
    return {
        "body": None if link == "world" else link,
        "pose": pose_of(side.R, side.t),
        "shape": shape_of(side.shape),
    }


def _pair(pair: ContactPair) -> Json:
    return {
        "name": pair.name,
        "alpha": pair.alpha.name,
        "beta": pair.beta.name,
        "mu_v": pair.mu_v,
        "mu_omega": pair.mu_omega,
        "rows": pair.rows,
        "k": pair.k,
    }
