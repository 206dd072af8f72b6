"""All bodies in pinocchio models, named, placed and numbered; what `System` is made from.

Bodies move on their own (all of them hang from the world), so what pinocchio says about several
of them at once is what it says about each: a model holds some of them.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.body import FIXED, Body
from quasistatic_ref.model.coordinates import MimicJoint, joint_key, no_coordinate
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.joints.joint import QUATERNION, Joint
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.tree import BASE, Tree, is_actuated
from quasistatic_ref.model.tree_model import TreeModel, body_frame, tree_model
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.text.together import together

ReadUrdf = Callable[[str | PathLike[str], Sequence[str | Path]], Tree]
"""A URDF's file, or its text that begins with ``<``, and where ``package://`` URIs are looked for
-> its tree."""
PART = 24
"""Most coordinates of a part, unless one body alone has more: of 48, a workspace takes several
times as long to make."""


class Part(NamedTuple):
    """Bodies that share one pinocchio Model.

    Parameters
    ----------
    model : pinocchio.Model
    frames : list of int
        The frame of each of their links.
    """

    model: pin.Model
    frames: list[int]


@dataclass(frozen=True, eq=False)
class World:
    """Several bodies as one system: their links, joints and masses, and their Models.

    Parameters
    ----------
    parts : tuple of Part
    joints : tuple of Joint
        Those with coordinates of their own, numbered as pinocchio does.
    mimics : tuple of MimicJoint
    links : tuple of str
        Number 0 is ``"world"``.
    masses : ndarray, shape (L,)
        Mass of each link as its tree says; the world has none [kg].
    centres : ndarray, shape (L, 3)
        Each link's centre of mass, in its frame [m].
    inertias : ndarray, shape (L, 3, 3)
        About each link's centre of mass, along the axes of its frame [kg m^2].
    shapes : tuple of PlacedShape
    roots : dict of str to int
        Number of each body's root link.
    start : ndarray, shape (n_q,)
        Initial configuration in pinocchio's order [m, rad, -].
    ignored : tuple of str
        What the trees' sources say and the model does not use.
    notes : tuple of str
        What was taken otherwise than they say.
    """

    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]
    mimics: tuple[MimicJoint, ...]
    links: tuple[str, ...]
    masses: Array
    centres: Array
    inertias: Array
    shapes: tuple[PlacedShape, ...]
    roots: dict[str, int]
    start: Array
    ignored: tuple[str, ...]
    notes: tuple[str, ...]

    @cached_property
    def places(self) -> dict[str, tuple[pin.Model, int]]:
        """For each joint, by its name in the Model: which Model it is in, and its number there."""
        return {
            name: (part.model, number)
            for part in self.parts
            for number, name in enumerate(part.model.names)
        }

    @cached_property
    def frames(self) -> list[tuple[pin.Model, int]]:
        """For each link but the world: which Model it is in, and its frame there."""
        return [(part.model, frame) for part in self.parts for frame in part.frames]


@together()
def trees_of(bodies: Iterable[Body]) -> tuple[Tree, ...]:
    """The tree of each body: files are read here.

    Raises
    ------
    ModelError
        If a URDF is not usable.
    """
    return tuple(map(_tree, bodies))


def _tree(body: Body) -> Tree:
    if isinstance(body.urdf, Tree):
        return body.urdf
    urdf_tree: ReadUrdf = part("urdf_tree")
    return urdf_tree(body.urdf, body.package_dirs)


def world_of(bodies: Sequence[Body], trees: Sequence[Tree]) -> World:
    """Bodies, of the trees that they have, in pinocchio models.

    Raises
    ------
    ModelError
        If an inertia is not usable, two bodies share a name, or a body names a joint that it
        does not have.
    """
    models: dict[str, TreeModel] = {}
    links = ["world"]
    roots = {}
    shapes = []
    joints: list[Joint] = []
    start: list[float] = []
    for body, tree in zip(bodies, trees, strict=True):
        if body.name in models:
            problem = "is the name of two bodies; rename one"
            raise ModelError(problem, field="body.name", value=body.name)
        made = models[body.name] = tree_model(tree, body.base, body.actuated)
        _check_joint_names(body, tree)
        _add_joints(body, tree, joints, start)
        first = roots[body.name] = len(links)
        links += [f"{body.name}/{link}" for link in tree.links]
        for shape in made.shapes:
            shapes.append(replace(shape, name=f"{body.name}/{shape.name}", link=first + shape.link))
    every = [link for tree in trees for link in tree.links.values()]
    return World(
        parts=tuple(_parts(bodies, list(models.values()))),
        joints=tuple(joints),
        mimics=tuple(mimic for name, made in models.items() for mimic in _mimics(name, made.tree)),
        links=tuple(links),
        masses=np.array([0.0, *(link.mass for link in every)]),
        centres=np.array([np.zeros(3), *(link.com for link in every)]),
        inertias=np.array([np.zeros((3, 3)), *(link.inertia for link in every)]),
        shapes=tuple(shapes),
        roots=roots,
        start=np.array(start),
        ignored=tuple(f"{name}: {x}" for name, made in models.items() for x in made.tree.ignored),
        notes=tuple(f"{name}: {x}" for name, made in models.items() for x in made.notes),
    )


def _parts(bodies: Sequence[Body], models: Sequence[TreeModel]) -> Iterator[Part]:
    """Bodies that follow one another, of PART coordinates at most, or one that has more."""
    first = 0
    size = 0
    for last, made in enumerate(models):
        if last > first and size + made.model.nv > PART:
            yield _part(bodies[first:last], models[first:last])
            first = last
            size = 0
        size += made.model.nv
    if models:
        yield _part(bodies[first:], models[first:])


def _part(bodies: Sequence[Body], models: Sequence[TreeModel]) -> Part:
    model = _joined(bodies, [made.model for made in models])
    of_bodies = zip(bodies, models, strict=True)
    links = [f"{body.name}/{link}" for body, made in of_bodies for link in made.tree.links]
    return Part(model, [body_frame(model, link) for link in links])


def _joined(bodies: Sequence[Body], models: Sequence[pin.Model]) -> pin.Model:
    """All bodies in one pinocchio model, joined in halves, since appending takes long."""
    if len(bodies) > 1:
        half = len(bodies) // 2
        first = _joined(bodies[:half], models[:half])
        rest = _joined(bodies[half:], models[half:])
        return pin.appendModel(first, rest, 0, pin.SE3.Identity())
    model = pin.Model()
    for body, alone in zip(bodies, models, strict=True):
        model = pin.appendModel(model, _prefixed(alone, body.name), 0, _anchor(body))
    return model


def _prefixed(model: pin.Model, name: str) -> pin.Model:
    for number in range(1, model.njoints):
        model.names[number] = joint_key(f"{name}/{model.names[number]}")
    for number in range(1, model.nframes):  # frame 0 is the universe
        frame = model.frames[number]
        frame.name = f"{name}/{frame.name}"
    return model


def _anchor(body: Body) -> pin.SE3:
    """Pose in the world of a body's model; zero along coordinates that q has."""
    xyz = np.array(body.xyz)
    if body.base == FIXED:
        return pin.SE3(rotation(np.asarray(body.rpy)), xyz)
    held = [i for i in BASES[body.base].twist if i < 3]
    xyz[held] = 0.0
    return pin.SE3(np.eye(3), xyz)


def _check_joint_names(body: Body, tree: Tree) -> None:
    kinds = {joint.name: joint for joint in tree.joints if joint.kind != FIXED}
    free = {name for name, joint in kinds.items() if joint.mimic is None}
    scalar = {name for name in free if issubclass(JOINTS[kinds[name].kind], AxisJoint)}
    moves = body.base != FIXED
    known = free | {BASE} if moves else free
    actuated = () if isinstance(body.actuated, str) else body.actuated
    for key, names, allowed in (
        ("actuated", actuated, known),
        ("positions", tuple(body.positions), scalar),
    ):
        for name in names:
            if name in allowed:
                continue
            joint = kinds.get(name)
            problem = f"has no such joint{suggestion(str(name), allowed)}"
            if joint is not None and joint.mimic is not None:
                problem = no_coordinate(joint.mimic.of)
            elif joint is not None:
                problem = "has no position that is one number; it starts without a turn"
            elif name == BASE and moves:
                problem = "is positioned by xyz and rpy; use these"
            elif name == BASE:
                problem = 'is fixed; set base = "floating" or "planar" to move it'
            raise ModelError(problem, field=f"{body.name}.{key}", value=name)
        if len(set(names)) != len(names):
            problem = "names a joint twice; leave one out"
            raise ModelError(problem, field=f"{body.name}.{key}", value=names)


def _add_joints(body: Body, tree: Tree, joints: list[Joint], start: list[float]) -> None:
    """Append a body's joints with coordinates, numbered as pinocchio does, and their start."""

    def add(kind: type[Joint], name: str, entries: Sequence[float]) -> None:
        actuated = is_actuated(name, body.actuated)
        q = slice(len(start), len(start) + len(entries))
        first = joints[-1].v.stop if joints else 0
        joint = kind(f"{body.name}/{name}", actuated, q, slice(first, first))
        joints.append(replace(joint, v=slice(first, first + len(joint.coordinates))))
        start.extend(entries)

    if body.base != FIXED:
        base = BASES[body.base]
        rpy = np.asarray(body.rpy)
        entries = base.at(np.asarray(body.xyz), rpy)
        if base.unit_vector == QUATERNION:  # with the last bits of runs that are recorded
            entries[base.lengths :] = pin.Quaternion(rotation(rpy)).normalized().coeffs()
        add(base, BASE, entries)
    for written in tree.joints:
        if written.kind == FIXED or written.mimic is not None:
            continue  # it has no coordinate: its column is added to its leader's (column_map.py)
        kind = JOINTS[written.kind]
        if issubclass(kind, TwistJoint):
            add(kind, written.name, kind.neutral())
            continue
        add(kind, written.name, kind.at(body.positions.get(written.name, 0.0)))
        limits = written.limits if kind.unit_vector is None else None
        joints[-1] = replace(joints[-1], effort=written.effort, limits=limits)


def _mimics(body: str, tree: Tree) -> Iterator[MimicJoint]:
    for joint, mimic in tree.mimics:
        leader = f"{body}/{mimic.of}"
        yield MimicJoint(f"{body}/{joint.name}", leader, mimic.multiplier, mimic.offset)
