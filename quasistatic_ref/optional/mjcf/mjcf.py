"""An MJCF model as URDF: MuJoCo reads it, and what the model here has no place for is named.

MJCF leaves much to a compiler: classes of defaults, inertias of geoms, frames of meshes. MuJoCo's
own is the reader. Its numbers are written as URDF, which is loaded and compared as any other.
pinocchio's reader is not used: it drops bodies, masses and names of joints without a word.
"""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.step.arrays import Array

FREE, BALL, SLIDE, HINGE = range(4)
"""Types of joints, as MuJoCo numbers them."""
GEOMS = ("plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf")
WORLD = "worldbody"
GREY = (0.5, 0.5, 0.5, 1.0)
"""The colour of a geom that is given none."""
HIDDEN = 3
"""The first group of geoms that MuJoCo does not draw unless it is asked to."""
LISTED = (
    "actuator", "sensor", "tendon", "site", "camera", "light", "key", "pair", "exclude", "numeric",
    "text", "tuple", "skin", "hfield", "material", "texture",
)  # fmt: skip
"""Elements that are named among what a system ignores."""


def mjcf_urdf(path: str | Path, base: str = "fixed") -> str:
    """The text of a URDF of the same bodies, for ``Body(name, urdf=text)``.

    Its links are the bodies, in the same frames, its joints the hinges and slides. What the bodies
    of the world touch is of its root link ``worldbody``; where a free joint moves the only body,
    that is the root. What else the file says and the model ignores stands in
    ``ignored`` of the :class:`~quasistatic_ref.model.system.System`, each element by its name.

    Parameters
    ----------
    path : str or Path
        Of the MJCF file. Its meshes are in its folder or below it.
    base : str
        That of the body: ``"floating"`` or ``"planar"`` for a free joint.

    Raises
    ------
    ModelError
        If MuJoCo is not installed or refuses the file; or if it says what a URDF cannot: naming
        element and attribute.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = Path(tempfile.mkdtemp()) / "ball.xml"
    >>> ball = '<body name="ball"><freejoint/><geom type="sphere" size="0.05" mass="0.3"/></body>'
    >>> _ = path.write_text(f"<mujoco><worldbody>{ball}</worldbody></mujoco>")
    >>> system = qr.System([qr.Body("b", qr.mjcf_urdf(path, "floating"), "floating")])
    >>> system.links, system.masses.tolist()
    (('world', 'b/ball'), [0.0, 0.3])
    """
    try:
        mujoco: Any = import_module("mujoco")
    except ImportError:
        problem = "mjcf needs MuJoCo: pip install 'quasistatic-ref[engines]'"
        raise ModelError(problem) from None
    with about_file(path):
        try:
            spec = mujoco.MjSpec.from_file(str(path))
            model = spec.compile()
        except ValueError as error:
            raise ModelError(f"MuJoCo refuses it: {' '.join(str(error).split())}") from None
        root = _root(model, base)
        robot = Element("robot", name="mjcf", version="1.1")
        _list_elements(model, robot)
        for i in range(model.nbody):
            if i or not root:
                _link(spec, model, i, robot)
            if i > root:
                _joints(model, i, robot)
        return tostring(robot, encoding="unicode")


def _root(model: Any, base: str) -> int:
    """The number of the body that is the root: 1 where it is free, else the world's, 0."""
    for i in range(model.neq):
        _refuse(model, "equality", i, "", "ties bodies or joints, which a URDF cannot")
    for i in range(model.nbody):
        if model.body_mocapid[i] >= 0:
            _refuse(model, "body", i, "mocap", "is not supported; give it joints and targets")
    if model.nflex:
        raise ModelError("is not supported: bodies are rigid", field="flex")
    free = [i for i in range(model.njnt) if model.jnt_type[i] == FREE]
    for i in free:
        alone = model.jnt_bodyid[i] == 1 and not np.any(model.body_parentid[2:] == 0)
        if not alone or np.any(model.geom_bodyid[_touching(model)] == 0):
            problem = "is supported for one body without others, and without shapes of the world; "
            _refuse(model, "joint", i, "type", problem + "put it in a file of its own")
        if base == "fixed":
            problem = 'moves its body freely; give the body base = "floating" or "planar"'
            _refuse(model, "joint", i, "type", problem)
    return 1 if free else 0


def _touching(model: Any) -> Array:
    """Whether each geom touches others and is not a plane or field of the world, shape (ngeom,)."""
    touches = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    endless = np.isin(model.geom_type, (0, 1)) & (model.geom_bodyid == 0)
    return np.asarray(touches & ~endless)


def _refuse(model: Any, kind: str, i: int, attribute: str, problem: str) -> None:
    field = f"{kind}[{_name(model, kind, i)}]" + (f".{attribute}" if attribute else "")
    raise ModelError(problem, field=field)


def _name(model: Any, kind: str, i: int) -> str:
    """The name of an element; its kind and number where it has none."""
    if kind == "body" and i == 0:
        return WORLD
    return str(getattr(model, kind)(i).name) or f"{kind}{i}"


def _list_elements(model: Any, robot: Element) -> None:
    """What is named among the ignored elements, by tags such as ``actuator.hip``."""
    SubElement(robot, "option")  # the scenario has h and gravity
    counts = {"actuator": model.nu, "camera": model.ncam, "material": model.nmat,
              "texture": model.ntex}  # fmt: skip
    for kind in LISTED:
        for i in range(counts.get(kind, getattr(model, f"n{kind}", 0))):
            SubElement(robot, re.sub(r"[^\w.-]", "_", f"{kind}.{_name(model, kind, i)}"))


def _link(spec: Any, model: Any, i: int, robot: Element) -> None:
    """Body i as a link: its inertia, the geoms that touch, and those that MuJoCo draws."""
    link = SubElement(robot, "link", name=_name(model, "body", i))
    if model.body_mass[i]:
        R = _pose(model.body_ipos[i], model.body_iquat[i]).rotation
        inertia = R @ np.diag(model.body_inertia[i]) @ R.T
        inertial = SubElement(link, "inertial")
        _origin(inertial, _shift(model.body_ipos[i]))
        SubElement(inertial, "mass", value=_text(model.body_mass[i]))
        upper = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
        SubElement(inertial, "inertia", {f"i{k}": _text(inertia[at]) for k, at in upper.items()})
    if model.body_gravcomp[i]:
        SubElement(link, "gravcomp")
    touching = _touching(model)
    for g in np.flatnonzero(model.geom_bodyid == i):
        _geom(spec, model, int(g), bool(touching[g]), link)


def _geom(spec: Any, model: Any, g: int, touches: bool, link: Element) -> None:
    kind = GEOMS[model.geom_type[g]]
    size = model.geom_size[g]
    shape = Element(kind)
    pose = _pose(model.geom_pos[g], model.geom_quat[g])
    if kind == "sphere":
        shape.set("radius", _text(size[0]))
    elif kind in ("capsule", "cylinder"):
        shape.set("radius", _text(size[0]))
        shape.set("length", _text(2 * size[1]))
    elif kind == "box":
        shape.set("size", _text(2 * size))
    elif kind == "mesh":
        number = model.geom_dataid[g]
        mesh = spec.meshes[number]
        file = Path(spec.modelfiledir) / spec.meshdir / mesh.file
        if not mesh.file:
            _refuse(model, "mesh", number, "vertex", "is not supported; name a file")
        shape.set("filename", str(file.resolve()))
        shape.set("scale", _text(mesh.scale))
        # MuJoCo moves a mesh to its centre of mass, and turns it to its axes of inertia.
        pose = pose * _pose(model.mesh_pos[number], model.mesh_quat[number]).inverse()
    elif touches:
        problem = f"is not supported for {kind}s that bodies touch with; use another shape"
        _refuse(model, "geom", g, "type", problem)
    else:
        SubElement(link, re.sub(r"[^\w.-]", "_", f"geom.{_name(model, 'geom', g)}"))
        return
    if touches:
        collision = _placed(link, "collision", shape, pose)
        if model.geom(g).name:
            collision.set("name", model.geom(g).name)
        SubElement(collision, "friction")  # the scenario has it, by tables of contacts
    rgba = _rgba(model, g)
    if model.geom_group[g] < HIDDEN and rgba[3]:
        material = SubElement(_placed(link, "visual", shape, pose), "material", name="")
        SubElement(material, "color", rgba=_text(rgba))


def _placed(link: Element, tag: str, shape: Element, pose: pin.SE3) -> Element:
    """A shape of a link, at a pose."""
    element = SubElement(link, tag)
    _origin(element, pose)
    SubElement(element, "geometry").append(shape)
    return element


def _rgba(model: Any, g: int) -> Array:
    """A geom's colour as MuJoCo draws it, shape (4,): its own, where it has no material or one."""
    own = model.geom_rgba[g]
    material = model.geom_matid[g]
    return np.asarray(own if material < 0 or np.any(own != GREY) else model.mat_rgba[material])


def _joints(model: Any, i: int, robot: Element) -> None:
    """What moves body i in its parent: its joints one after the other, each at its anchor.

    A joint with an anchor p turns about it: T p R(q) p^-1. Between joints are links without mass.
    """
    body, parent = (_name(model, "body", k) for k in (i, model.body_parentid[i]))
    pose = _pose(model.body_pos[i], model.body_quat[i])
    at = np.zeros(3)  # the anchor of the joint before
    first = model.body_jntadr[i]
    joints = range(first, first + model.body_jntnum[i])
    for j in joints:
        name = _name(model, "joint", j)
        kind = model.jnt_type[j]
        if kind not in (SLIDE, HINGE):
            _refuse(model, "joint", j, "type", "is not supported; use hinges and slides")
        anchor = model.jnt_pos[j] if kind == HINGE else at
        last = j == joints[-1] and not np.any(anchor)
        child = body if last else f"{body}:{name}"
        limited = bool(model.jnt_limited[j])
        turns = "revolute" if limited else "continuous"
        joint = _joint(robot, name, turns if kind == HINGE else "prismatic", parent, child)
        _origin(joint, pose * _shift(anchor - at))
        SubElement(joint, "axis", xyz=_text(model.jnt_axis[j]))
        ref = model.qpos0[model.jnt_qposadr[j]]  # positions here count from the file's pose
        lower, upper = model.jnt_range[j] - ref if limited else (0.0, 0.0)
        SubElement(joint, "limit", lower=_text(lower), upper=_text(upper), effort="0", velocity="0")
        _ignored_of_joint(model, j, joint)
        if not last:
            SubElement(robot, "link", name=child)
        parent = child
        pose = pin.SE3.Identity()
        at = anchor
    if parent != body:
        joint = _joint(robot, f"{body}:fixed", "fixed", parent, body)
        _origin(joint, pose * _shift(-at))


def _joint(robot: Element, name: str, kind: str, parent: str, child: str) -> Element:
    joint = SubElement(robot, "joint", name=name, type=kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


def _ignored_of_joint(model: Any, j: int, joint: Element) -> None:
    dof = model.jnt_dofadr[j]
    friction = model.dof_frictionloss[dof]
    damping = model.dof_damping[dof]
    if friction or damping:  # joint_friction = "urdf" reads the first
        SubElement(joint, "dynamics", friction=_text(friction), damping=_text(damping))
    for name, given in (
        ("armature", model.dof_armature[dof]),
        ("stiffness", model.jnt_stiffness[j]),
        ("gravcomp", model.jnt_actgravcomp[j]),
        ("ref", model.qpos0[model.jnt_qposadr[j]]),
    ):
        if given:
            SubElement(joint, name)


def _pose(position: Array, quaternion: Array) -> pin.SE3:
    """A pose from a position [m] and a quaternion [w x y z]."""
    return pin.SE3(pin.Quaternion(*quaternion).normalized(), position)


def _shift(t: Array) -> pin.SE3:
    """A pose that turns nothing."""
    return pin.SE3(np.eye(3), t)


def _origin(element: Element, pose: pin.SE3) -> None:
    """Write a pose [m] with R = Rz(yaw) Ry(pitch) Rx(roll)."""
    rpy = pin.rpy.matrixToRpy(pose.rotation)
    SubElement(element, "origin", xyz=_text(pose.translation), rpy=_text(rpy))


def _text(numbers: ArrayLike) -> str:
    return " ".join(repr(float(x)) for x in np.ravel(numbers))
