"""The step of a scenario as a case of the layer ``step``: what any program of the vectors reads."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.rotation import frame, quaternion_of
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.tables import ORIGIN, UPRIGHT
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.model.urdf.urdf_file import urdf_file
from quasistatic_ref.model.urdf.urdf_tree import FileJoint
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes import placed_shape as solids
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape, Shape
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.target import piecewise_linear
from quasistatic_ref.step.data import Array

KINDS = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
"""Joints that cases have."""
CORNERED = ("capsule", "cylinder", "cone", "convex")
"""Solids whose corners and edges are candidates of scenes, but not of cases."""


class SceneCases:
    """Cases of the steps of a scenario.

    Parameters
    ----------
    scenario : Scenario

    Raises
    ------
    InputError
        If it has what cases do not: balls as joints, friction of joints, Coulomb's law, second-
        order cones, several contacts of a pair of solids one of which is of CORNERED.
    """

    def __init__(self, scenario: Scenario) -> None:
        if scenario.of_bodies is not None or scenario.law != CONVEX:
            problem = "has friction of joints, a support, joint limits or Coulomb's law"
            raise InputError(problem, field="scene")
        if scenario.cone == "ellipsoid":
            raise InputError("has a second-order cone", field="scene")
        self._scenario = scenario
        system = scenario.system
        bodies = [*_bodies(system)]
        if kinds := {body["joint"] for body in bodies} - {*KINDS}:
            raise InputError(f"has a joint of kind {min(kinds)}", field="scene")
        self._levers = {w.body: _lever(system, w.body, bodies) for w in scenario.wrenches}
        placed = {s.name: s for pair in scenario.pairs for s in (pair.alpha, pair.beta)}
        shapes = {name: _shape(system, one) for name, one in placed.items()}
        for pair in scenario.pairs:
            kinds = {shapes[side.name]["shape"]["kind"] for side in (pair.alpha, pair.beta)}
            if pair.k > 1 and "cloud" not in kinds and (found := kinds & {*CORNERED}):
                raise InputError(f"has {pair.k} contacts of a {min(found)}", field=pair.name)
        self._fixed = {
            "mechanism": {"bodies": bodies},
            "shapes": shapes,
            "pairs": [
                {"name": p.name, "alpha": p.alpha.name, "beta": p.beta.name, "k": p.k,
                 "mu_v": p.mu_v, "mu_omega": p.mu_omega, "rows": p.rows}
                for p in scenario.pairs
            ],
            "K_q": scenario.K_q.tolist(),
            "gravity": scenario.gravity.tolist(),
            "cone": scenario.cone,
            "h": scenario.h,
        }  # fmt: skip

    def at(self, k: int, q: Array) -> Json:
        """The case of step k from q, shape (n_q,); target and wrenches are those at its end."""
        scenario = self._scenario
        t = (k + 1) * scenario.h
        case = {**self._fixed, "q": q.tolist(), "q_bar_a": scenario.targets(t).tolist()}
        case["wrenches"] = [self._wrench(w, t, q) for w in scenario.wrenches]
        if scenario.gravity_acts.any():
            acts = np.append(scenario.gravity_acts, np.zeros(scenario.system.n_u)) * 1.0
            case["tau"] = acts * scenario.system.gravity_force(q, scenario.gravity)
        return case

    def _wrench(self, given: Any, t: float, q: Array) -> Json:
        """A wrench at the centre of mass of a root link; its body's centre may be another."""
        value = piecewise_linear(given.times, given.values, t)
        link, lever = self._levers[given.body]
        R, _ = self._scenario.system.pose(q, link)
        torque = value[3:] + np.cross(R @ lever, value[:3])
        return {"body": link, "force": value[:3].tolist(), "torque": torque.tolist()}


def states_by(scenario: Scenario, answer: Callable[[Json], Json], steps: int) -> Array:
    """The run of a scene by a program of the layer ``step``.

    Parameters
    ----------
    scenario : Scenario
    answer : callable
        From the case of a step to its answer, of which ``q_next`` is read.
    steps : int

    Returns
    -------
    ndarray, shape (steps + 1, n_q)

    Raises
    ------
    InputError
        If cases cannot hold the scene.
    """
    cases = SceneCases(scenario)
    q = [scenario.system.q_start]
    for k in range(steps):
        q.append(scenario.system.normalised(answer(cases.at(k, q[-1]))["q_next"]))
    return np.array(q)


def _bodies(system: System) -> Iterator[Json]:
    """Every link as a body of a mechanism, moving ones in the order of their coordinates."""
    order = [joint.name for joint in system.joints]
    for body, text in zip(system.bodies, system.texts, strict=True):
        file = urdf_file(text)
        yield _base(system, body, file.root)
        children = {joint.name: f"{body.name}/{joint.child}" for joint in file.joints}
        placed = {file.root}
        left = list(file.joints)
        while left:
            ready = {f"{body.name}/{joint.name}": joint for joint in left if joint.parent in placed}
            others = [name for name in ready if name not in order]
            joint = ready[others[0] if others else min(ready, key=order.index)]
            yield _link(system, body, joint, children)
            placed.add(joint.child)
            left.remove(joint)


def _inertial(system: System, name: str) -> Json:
    i = system.link(name)
    return {"name": name, "mass": float(system.masses[i]), "com": system.centres[i].tolist(),
            "inertia": system.inertias[i].tolist()}  # fmt: skip


def _base(system: System, body: Body, root: str) -> Json:
    joints = {joint.name: joint for joint in system.joints}
    place = ORIGIN
    if body.base == "fixed":
        turned = quaternion_of(rotation(np.asarray(body.rpy)))
        place = {"xyz": np.asarray(body.xyz).tolist(), "quaternion": turned.tolist()}
    elif body.base == "planar":
        place = {"xyz": [0.0, 0.0, np.asarray(body.xyz).tolist()[2]], "quaternion": UPRIGHT}
    actuated = body.base != "fixed" and joints[f"{body.name}/base"].actuated
    return {**_inertial(system, f"{body.name}/{root}"), "parent": None, "joint": body.base,
            "placement": place, "axis": [0.0, 0.0, 1.0], "actuated": actuated}  # fmt: skip


def _link(system: System, body: Body, joint: FileJoint, children: dict[str, str]) -> Json:
    actuated = any(j.actuated for j in system.joints if j.name == f"{body.name}/{joint.name}")
    place = {"xyz": joint.t.tolist(), "quaternion": quaternion_of(joint.R).tolist()}
    found = {**_inertial(system, f"{body.name}/{joint.child}"), "joint": joint.kind,
             "parent": f"{body.name}/{joint.parent}", "placement": place,
             "axis": joint.axis.tolist(), "actuated": actuated}  # fmt: skip
    if joint.mimic is not None:
        found["mimic"] = {"of": children[joint.mimic.of],
                          "multiplier": joint.mimic.multiplier,
                          "offset": joint.mimic.offset}  # fmt: skip
    return found


def _lever(system: System, body: str, bodies: list[Json]) -> tuple[str, Array]:
    """A body's root link, and its centre of mass with all that is welded to it, less its own."""
    root = system.links[system.link(body)]
    at = {root: (np.eye(3), np.zeros(3))}
    for one in bodies:
        if one["joint"] == "fixed" and one["parent"] in at:
            R, t = at[one["parent"]]
            R_placed, t_placed = frame(one["placement"])
            at[one["name"]] = R @ R_placed, R @ t_placed + t
    links = [system.link(name) for name in at]
    places = [R @ system.centres[i] + t for i, (R, t) in zip(links, at.values(), strict=True)]
    whole = np.average(places, axis=0, weights=system.masses[links])
    return root, whole - system.centres[links[0]]


def _shape(system: System, one: PlacedShape) -> Json:
    """A shape where it is placed."""
    pose = {"xyz": one.t.tolist(), "quaternion": quaternion_of(one.R).tolist()}
    body = None if one.link == 0 else system.links[one.link]
    return {"body": body, "pose": pose, "shape": shape_record(one.shape)}


def shape_record(shape: Shape) -> Json:
    """A shape in the format of the vectors.

    Raises
    ------
    InputError
        If the format has none such.
    """
    match shape:
        case solids.Sphere():
            return {"kind": "sphere", "radius": shape.radius}
        case solids.Box():
            return {"kind": "box", "size": (2 * shape.half_extents).tolist()}
        case solids.Capsule() | solids.Cylinder() | solids.Cone():
            kind = type(shape).__name__.lower()
            return {"kind": kind, "radius": shape.radius, "length": 2 * shape.half_length}
        case solids.Ellipsoid():
            return {"kind": "ellipsoid", "half_axes": shape.half_axes.tolist()}
        case solids.HalfSpace():
            return {"kind": "halfspace", "normal": shape.normal.tolist(), "offset": shape.offset}
        case solids.PointCloud():
            return {"kind": "cloud", "points": shape.points.tolist()}
        case ConvexMesh():
            return {"kind": "convex", "vertices": shape.vertices.tolist()}
    raise InputError(f"has a {type(shape).__name__}", field="scene")
