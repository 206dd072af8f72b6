"""A URDF loaded through pinocchio, and compared with what its file says.

urdfdom reports trouble to standard error and carries on without the collision shape, the
inertia or the joint that it could not read. So every link's pose, every mass and every shape
is worked out twice, from the file alone and from what was loaded; a difference is an error.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.together import together
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.urdf.urdf_file import UrdfFile, urdf_file
from quasistatic_ref.model.urdf.urdf_inertia import checked_inertias, group_inertias
from quasistatic_ref.model.urdf.urdf_shapes import (
    checked_shapes,
    resolved_text,
    same_pose,
    with_spheres,
)
from quasistatic_ref.model.urdf.urdf_tree import link_poses, visiting_order
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.tolerances import LOADED

BASE = "base"
"""Name of the joint of a base that moves."""
NOT_IN_URDF = {kind: joint for kind, joint in JOINTS.items() if issubclass(joint, TwistJoint)}
"""Joints of files that URDF does not have."""


@dataclass(frozen=True, eq=False)
class Urdf:
    """A URDF that was loaded as written.

    Parameters
    ----------
    file : UrdfFile
        What it says.
    text : str
        What was loaded: the file's text without what the model ignores in links, each mesh URI
        replaced by the path of its file.
    model : pinocchio.Model
        Its kinematics and inertias.
    links : tuple of str
        Its links, the root first, parents before children.
    shapes : tuple of PlacedShape
        Its collision shapes; `link` counts in `links`, names are ``left_finger#0``, or those
        of their ``collision``.
    notes : tuple of str
        Where the model differs from its file: meshes as hulls, inertias that no body can have and
        that M_u does not need.
    """

    file: UrdfFile
    text: str
    model: pin.Model
    links: tuple[str, ...]
    shapes: tuple[PlacedShape, ...]
    notes: tuple[str, ...]


@together()
def loaded_urdf(
    path: str | Path,
    *,
    base: str = "fixed",
    actuated: Sequence[str] = (),
    package_dirs: Sequence[str | Path] = (),
) -> Urdf:
    """One URDF, loaded and compared with its file.

    Parameters
    ----------
    path : str or Path
    base : str
        ``"fixed"``; or ``"floating"``, ``"planar"`` or ``"ball"``: a joint named ``base``, with
        six, three or three degrees of freedom, between the world and the root link.
    actuated : sequence of str, or "all"
        Joints that have a stiffness. The inertia of a link that only these move need not be
        physically consistent.
    package_dirs : sequence of str or Path
        Where ``package://`` URIs are looked for.

    Raises
    ------
    ModelError
        If the file is not usable, or anything in it was not loaded as written.
    """
    file = urdf_file(path)
    with about_file(file.path):
        moving = _moving_joints(file, base)
        unactuated = [] if actuated == "all" else [name for name in moving if name not in actuated]
        inertias = checked_inertias(file, unactuated, base)
        text = resolved_text(file, package_dirs)
        model, geometry = _loaded(text, base)
        _check_names(file, model, moving)
        _check_poses(file, model)
        _check_inertias(file, model)
        links = (file.root, *(joint.child for joint in file.joints))
        frames = [body_frame(model, link) for link in links]
        shapes, hulls = checked_shapes(file, model, geometry, links, frames, package_dirs)
    return Urdf(file, text, model, links, shapes, (*file.notes, *inertias, *hulls))


def body_frame(model: pin.Model, link: str) -> int:
    """Number of a link's frame; a joint's frame may have the same name."""
    return int(model.getFrameId(link, pin.FrameType.BODY))


def _moving_joints(file: UrdfFile, base: str) -> list[str]:
    """Names of the joints that are not fixed, the base's last."""
    moving = [joint.name for joint in file.joints if joint.kind != "fixed"]
    if base == "fixed":
        return moving
    if any(joint.name == BASE for joint in file.joints):
        problem = f"this name is taken by the {base} base; rename the joint"
        raise ModelError(problem, field=f"joint[{BASE}]")
    return [*moving, BASE]


def urdf_model(text: str, base: str) -> pin.Model:
    """The pinocchio model of a URDF's text; ModelError where a mimic joint cannot be met."""
    root = () if base == "fixed" else (BASES[base].pinocchio(), BASE)
    readable, names, kinds = _readable(text)
    model = _with_twist_joints(pin.buildModelFromXML(readable, *root, mimic=True), kinds)
    for number in range(1, model.njoints):
        model.names[number] = names.get(model.names[number], model.names[number])
    for frame in model.frames:
        if frame.type != pin.FrameType.BODY:
            frame.name = names.get(frame.name, frame.name)
    return model


def _readable(text: str) -> tuple[str, dict[str, str], dict[str, type[TwistJoint]]]:
    """A URDF that pinocchio can read, and what its joints are called here, by their names in it.

    Joints are numbered where pinocchio, which visits the joints of a link in alphabetical order,
    would meet a mimic joint before its leader. The third value has the kinds of joints, by name,
    that URDF does not have, and that float in its text.

    Raises
    ------
    ModelError
        If there are such joints and mimic joints, whose copies in pinocchio point to the first.
    """
    if not any(word in text for word in ("mimic", *NOT_IN_URDF)):  # which saves the time of most
        return text, {}, {}
    robot = ElementTree.fromstring(text)
    kinds = {}
    for joint in robot.findall("joint"):
        kind = NOT_IN_URDF.get(joint.attrib["type"])
        if kind is not None:
            kinds[joint.attrib["name"]] = kind
            joint.set("type", "floating")
    if kinds and robot.find("joint/mimic") is not None:
        raise ModelError("cannot stand in a file with mimic joints", field=f"joint[{min(kinds)}]")
    order = visiting_order(robot)
    names = {f"{number:04}": name for number, name in enumerate(order)}
    numbers = {name: number for number, name in names.items()}
    for joint in robot.findall("joint") if order else ():
        joint.set("name", numbers[joint.attrib["name"]])
        for mimic in joint.findall("mimic"):
            mimic.set(
                "joint", numbers.get(mimic.get("joint", ""), "")
            )  # a fixed joint's may be none
    return ElementTree.tostring(robot, encoding="unicode"), names, kinds


def _with_twist_joints(model: pin.Model, kinds: dict[str, type[TwistJoint]]) -> pin.Model:
    """The model with joints that URDF does not have, by their names, in the place of others."""
    if not kinds:
        return model
    made = pin.Model()
    made.appendBodyToJoint(0, model.inertias[0], pin.SE3.Identity())
    for i in range(1, model.njoints):
        name = model.names[i]
        joint = kinds[name].pinocchio() if name in kinds else model.joints[i]
        made.addJoint(model.parents[i], joint, model.jointPlacements[i], name)
        made.appendBodyToJoint(i, model.inertias[i], pin.SE3.Identity())
    scalar = [i for i in range(1, model.njoints) if model.nqs[i] == 1]
    before = [model.idx_qs[i] for i in scalar]
    after = [made.idx_qs[i] for i in scalar]
    made.lowerPositionLimit[after] = model.lowerPositionLimit[before]
    made.upperPositionLimit[after] = model.upperPositionLimit[before]
    turns = [i for i in range(1, model.njoints) if model.nvs[i] == 1]
    efforts = [model.effortLimit[model.idx_vs[i]] for i in turns]
    made.effortLimit[[made.idx_vs[i] for i in turns]] = efforts
    for number in range(1, model.nframes):  # frame 0 is the universe
        made.addFrame(model.frames[number], False)  # the joints have the inertias
    return made


def with_turns(text: str) -> str:
    """A URDF whose revolute joints are made continuous: in q they have a cosine and a sine.

    A joint that mimics another, or is mimicked, stays as it is: it may turn by more than pi.
    """
    robot = ElementTree.fromstring(text)
    followed = {mimic.get("joint") for mimic in robot.iter("mimic")}
    for joint in robot.findall("joint"):
        alone = joint.find("mimic") is None and joint.get("name") not in followed
        if joint.get("type") == "revolute" and alone:
            joint.set("type", "continuous")
    return ElementTree.tostring(robot, encoding="unicode")


def _loaded(text: str, base: str) -> tuple[pin.Model, pin.GeometryModel]:
    # From the text, not the path: what is loaded is what was read and checked.
    try:
        model = urdf_model(text, base)
        geometry = pin.buildGeomFromUrdfString(
            model, with_spheres(_readable(text)[0]), pin.GeometryType.COLLISION
        )
    except ModelError:
        raise
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        if "valid URDF" in reason:
            reason = "its URDF parser refuses it, for the reason printed on standard error"
        raise ModelError(f"pinocchio cannot load it: {reason}") from None
    return model, geometry


def _check_names(file: UrdfFile, model: pin.Model, moving: Sequence[str]) -> None:
    frames = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
    joints = list(model.names)[1:]  # the first is the universe
    for what, written, loaded in (("links", file.links, frames), ("joints", moving, joints)):
        if sorted(written) != sorted(loaded):
            problem = f"differ from those loaded, {sorted(loaded)}"
            raise ModelError(problem, field=what, value=sorted(written))


def _check_poses(file: UrdfFile, model: pin.Model) -> None:
    """Compare every link's pose at position zero and at one without symmetries."""
    moving = [joint for joint in file.joints if joint.kind != "fixed" and joint.mimic is None]
    data = model.createData()
    for step in (0.0, 0.1):
        positions = {joint.name: step * k for k, joint in enumerate(moving, start=3)}
        delta_q = np.zeros(model.nv)
        for name, position in positions.items():
            delta_q[model.joints[model.getJointId(name)].idx_v] = position
        q = pin.integrate(model, pin.neutral(model), delta_q)
        pin.framesForwardKinematics(model, data, q)
        poses = link_poses(file.root, file.joints, positions)
        for link, (R, t) in poses.items():
            if not same_pose(data.oMf[body_frame(model, link)], R, t):
                problem = "its joint's origin, axis or mimic was not loaded as written"
                raise ModelError(problem, field=f"link[{link}]")


def _check_inertias(file: UrdfFile, model: pin.Model) -> None:
    """Compare the inertia of each rigid group."""
    for first, inertia in group_inertias(file).items():
        written = inertia.matrix()
        loaded = model.inertias[model.frames[body_frame(model, first)].parentJoint].matrix()
        if np.abs(written - loaded).max() > LOADED * np.abs(written).max():
            problem = f"mass, centre or inertia was not loaded as written ({loaded[0, 0]:g} kg)"
            raise ModelError(problem, field=f"link[{first}].inertial", value=float(written[0, 0]))
