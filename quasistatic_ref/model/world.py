"""All URDFs in one pinocchio model, named, placed and numbered; what `System` is made from."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.urdf.file import UrdfFile
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.together import together
from quasistatic_ref.model.body import FIXED, Body
from quasistatic_ref.model.coordinates import MimicJoint, joint_key, no_coordinate
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.joints.joint import QUATERNION, Joint
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.urdf.urdf import BASE, Urdf, loaded_urdf, urdf_model
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import PlacedShape


@dataclass(frozen=True, eq=False)
class World(Plain):
    """Several bodies in one pinocchio model.

    It holds the files, of which :attr:`model` is made: pinocchio 4.1's own pickles
    lose which joint a mimic follows, and a model that is read from one may end the process.

    Parameters
    ----------
    bodies : tuple of Body
    texts : tuple of str
        The URDF of each.
    files : tuple of UrdfFile
        What they say.
    joints : tuple of Joint
        Those with coordinates of their own, numbered as pinocchio does.
    mimics : tuple of MimicJoint
    links : tuple of str
        Number 0 is ``"world"``.
    masses : ndarray, shape (L,)
        Mass of each link as its file says; the world has none [kg].
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
        What the URDFs say and the model does not use.
    notes : tuple of str
        What was taken otherwise than the URDFs say.
    """

    bodies: tuple[Body, ...]
    texts: tuple[str, ...]
    files: tuple[UrdfFile, ...] = field(compare=False)
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
    def model(self) -> pin.Model:
        """All bodies in one pinocchio model."""
        models = [urdf_model(file, b.base) for b, file in zip(self.bodies, self.files, strict=True)]
        return joined(self.bodies, models)


@together()
def world_of(bodies: tuple[Body, ...]) -> World:
    """Load every body's URDF and append it to one model.

    Raises
    ------
    ModelError
        If a URDF is not usable, two bodies share a name, or a body names a joint that it
        does not have.
    """
    urdfs: dict[str, Urdf] = {}
    for body in bodies:
        if body.name in urdfs:
            problem = "is the name of two bodies; rename one"
            raise ModelError(problem, field="body.name", value=body.name)
        urdf = loaded_urdf(
            body.urdf, base=body.base, actuated=body.actuated, package_dirs=body.package_dirs
        )
        _check_joint_names(body, urdf)
        urdfs[body.name] = urdf
    written = [urdf.file.links[link] for urdf in urdfs.values() for link in urdf.links]
    links = ["world"]
    roots = {}
    shapes = []
    for name, urdf in urdfs.items():
        first = roots[name] = len(links)
        links += [f"{name}/{link}" for link in urdf.links]
        for shape in urdf.shapes:
            shapes.append(replace(shape, name=f"{name}/{shape.name}", link=first + shape.link))
    joints: list[Joint] = []
    start: list[float] = []
    for body in bodies:
        _add_joints(body, urdfs[body.name].file, joints, start)
    return World(
        bodies=bodies,
        texts=tuple(urdf.file.text for urdf in urdfs.values()),
        files=tuple(urdf.file for urdf in urdfs.values()),
        joints=tuple(joints),
        mimics=tuple(m for name, urdf in urdfs.items() for m in _mimics(name, urdf)),
        links=tuple(links),
        masses=np.array([0.0, *(link.mass for link in written)]),
        centres=np.array([np.zeros(3), *(link.com for link in written)]),
        inertias=np.array([np.zeros((3, 3)), *(link.inertia for link in written)]),
        shapes=tuple(shapes),
        roots=roots,
        start=np.array(start),
        ignored=tuple(f"{name}: {x}" for name, urdf in urdfs.items() for x in urdf.file.ignored),
        notes=tuple(f"{name}: {x}" for name, urdf in urdfs.items() for x in urdf.notes),
    )


def joined(bodies: Sequence[Body], models: Sequence[pin.Model]) -> pin.Model:
    """All bodies in one pinocchio model, joined in halves, since appending takes long."""
    if len(bodies) > 1:
        half = len(bodies) // 2
        first = joined(bodies[:half], models[:half])
        rest = joined(bodies[half:], models[half:])
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
    """Pose of a body's model in the world, where q does not hold it."""
    xyz = np.array(body.xyz)
    if body.base == FIXED:
        return pin.SE3(rotation(np.asarray(body.rpy)), xyz)
    held = [i for i in BASES[body.base].twist if i < 3]
    xyz[held] = 0.0
    return pin.SE3(np.eye(3), xyz)


def _check_joint_names(body: Body, urdf: Urdf) -> None:
    kinds = {joint.name: joint for joint in urdf.file.joints if joint.kind != FIXED}
    free = {name for name, joint in kinds.items() if joint.mimic is None}
    scalar = {name for name in free if issubclass(JOINTS[kinds[name].kind], AxisJoint)}
    moves = body.base != FIXED
    known = free | {BASE} if moves else free
    actuated = () if body.actuated == "all" else body.actuated
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
                problem = "is positioned by xyz and rpy"
            elif name == BASE:
                problem = 'is fixed; set base = "floating" or "planar" to move it'
            raise ModelError(problem, field=f"{body.name}.{key}", value=name)
        if len(set(names)) != len(names):
            raise ModelError("names a joint twice", field=f"{body.name}.{key}", value=names)


def _add_joints(body: Body, file: UrdfFile, joints: list[Joint], start: list[float]) -> None:
    """Append a body's joints with coordinates, numbered as pinocchio does, and their start."""

    def add(kind: type[Joint], name: str, entries: Sequence[float]) -> None:
        is_actuated = body.actuated == "all" or name in body.actuated
        q = slice(len(start), len(start) + len(entries))
        first = joints[-1].v.stop if joints else 0
        joint = kind(f"{body.name}/{name}", is_actuated, q, slice(first, first))
        joints.append(replace(joint, v=slice(first, first + len(joint.coordinates))))
        start.extend(entries)

    if body.base != FIXED:
        base = BASES[body.base]
        rpy = np.asarray(body.rpy)
        entries = base.at(np.asarray(body.xyz), rpy)
        if base.unit_vector == QUATERNION:  # with the last bits of runs that are recorded
            entries[base.lengths :] = pin.Quaternion(rotation(rpy)).normalized().coeffs()
        add(base, BASE, entries)
    for written in file.in_order():
        if written.kind == FIXED or written.mimic is not None:
            continue  # it has no coordinate: its column is added to its leader's (column_map.py)
        kind = JOINTS[written.kind]
        if issubclass(kind, TwistJoint):
            add(kind, written.name, kind.at(np.zeros(3), np.zeros(3)))
            continue
        add(kind, written.name, kind.at(body.positions.get(written.name, 0.0)))
        limits = written.limits if kind.unit_vector is None else None
        joints[-1] = replace(joints[-1], effort=written.effort, limits=limits)


def _mimics(body: str, urdf: Urdf) -> list[MimicJoint]:
    return [
        MimicJoint(f"{body}/{joint.name}", f"{body}/{m.of}", m.multiplier, m.offset)
        for joint in urdf.file.joints
        if (m := joint.mimic)
    ]
