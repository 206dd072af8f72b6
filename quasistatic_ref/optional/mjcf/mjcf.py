"""An MJCF model as URDF: MuJoCo reads it, and what the model here has no place for is named.

MJCF leaves much to a compiler: classes of defaults, inertias of geoms, frames of meshes, where
files are. MuJoCo's own is the reader, also of meshes. Its numbers are written as URDF, which is
loaded and compared as any other, and then with MuJoCo's geoms. pinocchio's reader is not used: it
drops bodies, masses and names of joints without a word.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.optional.mjcf.compared import check_shapes
from quasistatic_ref.optional.mjcf.compiler import compiled
from quasistatic_ref.optional.mjcf.fence import Fence
from quasistatic_ref.optional.mjcf.geoms import (
    BALL,
    FREE,
    GEOMS,
    HINGE,
    SLIDE,
    drawn,
    rgba,
    touching,
)
from quasistatic_ref.optional.mjcf.ignored import ignored_of_free
from quasistatic_ref.optional.mjcf.names import Names
from quasistatic_ref.scenario.bodies import MJCF_URDF
from quasistatic_ref.step.arrays import Array

if TYPE_CHECKING:
    from mujoco import MjModel


def mjcf_urdf(path: str | Path, base: str = "fixed", roots: Sequence[str | Path] = ()) -> str:
    """The text of a URDF of the same bodies, for ``Body(name, urdf=text)``.

    Its links are the bodies, in the same frames, its joints the hinges, slides and balls. What the
    bodies of the world touch is of its root link ``worldbody``; where a free joint moves the only
    body, that is the root. Meshes stand in the text, as MuJoCo compiled them. What else the file
    says and the model ignores stands in ``ignored`` of the
    :class:`~quasistatic_ref.model.system.System`, each element and attribute by its name.

    Parameters
    ----------
    path : str or Path
        Of the MJCF file.
    base : str
        That of the body: ``"floating"`` or ``"planar"`` for a free joint.
    roots : sequence of str or Path
        Folders from which the file may read besides its own.

    Raises
    ------
    ModelError
        If MuJoCo is not installed or refuses the file; if it reads from elsewhere, or asks for more
        than any robot has; or if it says what a URDF cannot: naming
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
    with about_file(path):
        model, ignored = compiled_model(Path(path), roots)
        names = Names.of(model)
        root = _root(model, names, base)
        robot = Element("robot", name="mjcf", version="1.1")
        if root:
            ignored += ignored_of_free(model, names)
        for i in range(root, model.nbody):
            _link(model, names, i, robot, ignored)
        for i in range(root + 1, model.nbody):
            _joints(model, names, i, robot, ignored)
        for name in dict.fromkeys(ignored):
            SubElement(robot, "ignored", name=name)
        text = tostring(robot, encoding="unicode")
        check_shapes(text, base, model, names)
        return text


def compiled_model(
    path: Path, roots: Sequence[str | Path], simulated: bool = False
) -> tuple[MjModel, list[str]]:
    """What MuJoCo makes of a file, and what of it is ignored; the arguments of ``compiled``.

    Raises
    ------
    ModelError
        As of :func:`mjcf_urdf`, but for what a URDF cannot say.
    """
    try:
        return compiled(Fence(path, roots), simulated)
    except ImportError:
        problem = "MJCF needs MuJoCo: pip install 'quasistatic-ref[engines]'"
        raise ModelError(problem) from None


def _root(model: MjModel, names: Names, base: str) -> int:
    """The number of the body that is the root: 1 where it is free, else the world's, 0."""
    for i in range(model.neq):
        problem = "ties bodies or joints, which a URDF cannot"
        raise ModelError(problem, field=f"equality[{model.equality(i).name or i}]")
    for i in range(model.nbody):
        if model.body_mocapid[i] >= 0:
            problem = "is not supported; give it joints and targets"
            raise ModelError(problem, field=f"body[{names.bodies[i]}].mocap")
    if model.nflex:
        raise ModelError("is not supported: bodies are rigid", field="flex")
    free = [i for i in range(model.njnt) if model.jnt_type[i] == FREE]
    for i in free:
        field = f"joint[{names.joints[i]}].type"
        alone = model.jnt_bodyid[i] == 1 and not np.any(model.body_parentid[2:] == 0)
        if not alone or np.any(model.geom_bodyid[touching(model)] == 0):
            problem = "is supported for one body without others, and without shapes of the world; "
            raise ModelError(problem + "put it in a file of its own", field=field)
        if base == "fixed":
            problem = 'moves its body freely; give the body base = "floating" or "planar"'
            raise ModelError(problem, field=field)
    return 1 if free else 0


def _link(model: MjModel, names: Names, i: int, robot: Element, ignored: list[str]) -> None:
    """Body i as a link: its inertia, the geoms that touch, and those that MuJoCo draws."""
    link = SubElement(robot, "link", name=names.bodies[i])
    if model.body_mass[i]:
        R = _pose(model.body_ipos[i], model.body_iquat[i]).rotation
        inertia = R @ np.diag(model.body_inertia[i]) @ R.T
        inertial = SubElement(link, "inertial")
        _origin(inertial, _shift(model.body_ipos[i]))
        SubElement(inertial, "mass", value=_text(model.body_mass[i]))
        upper = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
        SubElement(inertial, "inertia", {f"i{k}": _text(inertia[at]) for k, at in upper.items()})
    touches = touching(model)
    for g in np.flatnonzero(model.geom_bodyid == i).tolist():
        _geom(model, names, g, bool(touches[g]), link, ignored)


def _geom(
    model: MjModel, names: Names, g: int, touches: bool, link: Element, ignored: list[str]
) -> None:
    where = f"geom[{names.geoms[g]}]"
    shape = _shape(model, g)
    if shape is None and touches:
        problem = f"is not supported for {GEOMS[model.geom_type[g]]}s that bodies touch with; "
        raise ModelError(problem + "use another shape", field=f"{where}.type")
    if shape is None or not (touches or drawn(model, g)):
        ignored.append(where)
        return
    pose = _pose(model.geom_pos[g], model.geom_quat[g])
    if touches:
        collision = _placed(link, "collision", shape, pose)
        if model.geom(g).name:
            collision.set("name", model.geom(g).name)
        SubElement(collision, "friction")  # the scenario has it, by tables of contacts
    if drawn(model, g):
        material = SubElement(_placed(link, "visual", shape, pose), "material", name="")
        SubElement(material, "color", rgba=_text(rgba(model, g)))


def _shape(model: MjModel, g: int) -> Element | None:
    """A geom's shape in its own frame; None if a URDF has no name for it."""
    kind = GEOMS[model.geom_type[g]]
    size = model.geom_size[g]
    if kind == "sphere":
        return Element(kind, radius=_text(size[0]))
    if kind in ("capsule", "cylinder"):
        return Element(kind, radius=_text(size[0]), length=_text(2 * size[1]))
    if kind == "box":
        return Element(kind, size=_text(2 * size))
    if kind == "mesh":
        mesh = model.mesh(model.geom_dataid[g])
        vertices = model.mesh_vert[mesh.vertadr[0] :][: mesh.vertnum[0]]
        faces = model.mesh_face[mesh.faceadr[0] :][: mesh.facenum[0]]
        return Element(kind, vertex=_text(vertices), face=" ".join(map(str, faces.ravel())))
    return None


def _placed(link: Element, tag: str, shape: Element, pose: pin.SE3) -> Element:
    """A shape of a link, at a pose."""
    element = SubElement(link, tag)
    _origin(element, pose)
    SubElement(element, "geometry").append(shape)
    return element


def _joints(model: MjModel, names: Names, i: int, robot: Element, ignored: list[str]) -> None:
    """What moves body i in its parent: its joints one after the other, each at its anchor.

    A joint with an anchor p turns about it: T p R(q) p^-1. Between joints are links without mass.
    """
    body = names.bodies[i]
    parent = names.bodies[model.body_parentid[i]]
    pose = _pose(model.body_pos[i], model.body_quat[i])
    at = np.zeros(3)  # the anchor of the joint before
    first = model.body_jntadr[i]
    joints = range(first, first + model.body_jntnum[i])
    for j in joints:
        name = names.joints[j]
        kind = model.jnt_type[j]
        anchor = at if kind == SLIDE else model.jnt_pos[j]
        last = j == joints[-1] and not np.any(anchor)
        child = body if last else names.free_body(f"{body}:{name}")
        limited = bool(model.jnt_limited[j])
        turns = "revolute" if limited else "continuous"
        word = {SLIDE: "prismatic", HINGE: turns, BALL: "ball"}[kind]
        joint = _joint(robot, name, word, parent, child)
        _origin(joint, pose * _shift(anchor - at))
        friction = model.dof_frictionloss[model.jnt_dofadr[j]]
        if kind == BALL:
            ignored += [f"joint[{name}].range"] * limited
            ignored += [f"joint[{name}].frictionloss"] * bool(friction)
        else:
            _measure(model, j, joint)
            if friction:  # joint_friction = "urdf" reads it
                SubElement(joint, "dynamics", friction=_text(friction))
        if not last:
            SubElement(robot, "link", name=child)
        parent = child
        pose = pin.SE3.Identity()
        at = anchor
    if parent != body:
        joint = _joint(robot, names.free_joint(f"{body}:fixed"), "fixed", parent, body)
        _origin(joint, pose * _shift(-at))


def _measure(model: MjModel, j: int, joint: Element) -> None:
    """The axis of a hinge or slide, and its limits, counted from the file's pose."""
    SubElement(joint, "axis", xyz=_text(model.jnt_axis[j]))
    ref = model.qpos0[model.jnt_qposadr[j]]
    lower, upper = model.jnt_range[j] - ref if model.jnt_limited[j] else (0.0, 0.0)
    SubElement(joint, "limit", lower=_text(lower), upper=_text(upper), effort="0", velocity="0")


def _joint(robot: Element, name: str, kind: str, parent: str, child: str) -> Element:
    joint = SubElement(robot, "joint", name=name, type=kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=child)
    return joint


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


MJCF_URDF.fill(mjcf_urdf)
