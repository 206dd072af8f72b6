"""A URDF as a pinocchio model with shapes, made of what its file says.

pinocchio's own reader reports trouble to standard error and carries on without the collision shape,
the inertia or the joint that it could not read. So a file is read here, once, and the model is made
joint by joint.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.urdf.file import FileLink, UrdfFile, urdf_file
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.urdf.inertia import checked_inertias, link_inertia
from quasistatic_ref.model.urdf.shapes import placed_shapes
from quasistatic_ref.shapes.placed_shape import PlacedShape

BASE = "base"
"""Name of the joint of a base that moves."""


@dataclass(frozen=True, eq=False)
class Urdf:
    """A URDF as a model.

    Parameters
    ----------
    file : UrdfFile
        What it says.
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
    model: pin.Model
    links: tuple[str, ...]
    shapes: tuple[PlacedShape, ...]
    notes: tuple[str, ...]


def loaded_urdf(
    path: str | Path | UrdfFile,
    *,
    base: str = "fixed",
    actuated: Sequence[str] = (),
    package_dirs: Sequence[str | Path] = (),
) -> Urdf:
    """One URDF, read and made into a model.

    Parameters
    ----------
    path : str or Path; or UrdfFile
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
        If the file is not usable.
    """
    file = urdf_file(path)
    with about_file(file.path):
        moving = _moving_joints(file, base)
        unactuated = [] if actuated == "all" else [name for name in moving if name not in actuated]
        model = urdf_model(file, base)
        inertias = checked_inertias(file, model, unactuated, base)
        links = (file.root, *(joint.child for joint in file.joints))
        frames = [model.frames[body_frame(model, link)].placement for link in links]
        shapes, hulls = placed_shapes(file, links, frames, package_dirs)
    return Urdf(file, model, links, shapes, (*file.notes, *inertias, *hulls))


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


def urdf_model(file: UrdfFile, base: str, *, turns: bool = False) -> pin.Model:
    """The pinocchio model of a file; ModelError where a mimic joint cannot be met.

    Parameters
    ----------
    file : UrdfFile
    base : str
    turns : bool
        Whether revolute joints are made continuous: in q they have a cosine and a sine, which are
        then computed here, correctly rounded. A joint that mimics another, or is mimicked, stays.
    """
    model = pin.Model()
    number = 0
    if base != "fixed":
        number = model.addJoint(0, BASES[base].pinocchio(), pin.SE3.Identity(), BASE)
    _add_link(model, file.links[file.root], number, pin.SE3.Identity(), 0)
    followed = {joint.mimic.of for joint in file.joints if joint.mimic}
    for joint in file.in_order():
        parent = body_frame(model, joint.parent)
        number = model.frames[parent].parentJoint
        placement = model.frames[parent].placement * pin.SE3(joint.R, joint.t)
        if joint.kind != "fixed":
            alone = joint.mimic is None and joint.name not in followed
            kind = "continuous" if turns and alone and joint.kind == "revolute" else joint.kind
            number = model.addJoint(number, JOINTS[kind].model(joint.axis), placement, joint.name)
            placement = pin.SE3.Identity()
        _add_link(model, file.links[joint.child], number, placement, parent)
    for joint in file.joints:
        if joint.mimic is not None:
            leader = model.getJointId(joint.mimic.of)
            how = joint.mimic.multiplier, joint.mimic.offset
            model = pin.transformJointIntoMimic(model, leader, model.getJointId(joint.name), *how)
    return model


def _add_link(
    model: pin.Model, link: FileLink, joint: int, placement: pin.SE3, parent: int
) -> None:
    model.appendBodyToJoint(joint, link_inertia(link), placement)
    model.addBodyFrame(link.name, joint, placement, parent)
