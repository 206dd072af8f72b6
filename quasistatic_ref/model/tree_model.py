"""A tree as a pinocchio model, made joint by joint, with the places of its shapes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.model.inertia import checked_inertias, link_inertia
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.tree import BASE, Tree, TreeLink, is_actuated
from quasistatic_ref.shapes.placed_shape import PlacedShape


@dataclass(frozen=True, eq=False)
class TreeModel:
    """The tree of a body with its pinocchio Model and placed shapes.

    Parameters
    ----------
    tree : Tree
    model : pinocchio.Model
        Its kinematics and inertias. Revolute joints are continuous: in q they have a cosine and a
        sine, which are computed here, correctly rounded. A joint that mimics another, or is
        mimicked, is as it is in the tree.
    shapes : tuple of PlacedShape
        `link` counts the tree's links.
    notes : tuple of str
        Those of the tree, and inertias that no body can have and that M_u does not need.
    """

    tree: Tree
    model: pin.Model
    shapes: tuple[PlacedShape, ...]
    notes: tuple[str, ...]


def tree_model(tree: Tree, base: str = "fixed", actuated: str | Sequence[str] = ()) -> TreeModel:
    """The pinocchio Model of a tree, with its shapes and notes.

    Parameters
    ----------
    tree : Tree
    base : str
        ``"fixed"``; or ``"floating"``, ``"planar"`` or ``"ball"``: a joint named ``base``, with
        six, three or three degrees of freedom, between the world and the root link.
    actuated : sequence of str, "joints" or "all"
        As of :class:`~quasistatic_ref.model.body.Body`:
        joints that have a stiffness. The inertia of a link that only these move need not be
        physically consistent.

    Raises
    ------
    ModelError
        If an inertia is needed that is none, or the base's name is taken.
    """
    with about_file(tree.path):
        moving = _moving_joints(tree, base)
        unactuated = [name for name in moving if not is_actuated(name, actuated)]
        model = _pinocchio_model(tree, base)
        inertias = checked_inertias(tree, model, unactuated, base)
    return TreeModel(tree, model, tuple(_placed_shapes(tree, model)), (*tree.notes, *inertias))


def body_frame(model: pin.Model, link: str) -> int:
    """Number of a link's frame; a joint's frame may have the same name."""
    return int(model.getFrameId(link, pin.FrameType.BODY))


def _moving_joints(tree: Tree, base: str) -> list[str]:
    """Names of the joints that are not fixed, the base's last."""
    moving = [joint.name for joint in tree.joints if joint.kind != "fixed"]
    if base == "fixed":
        return moving
    if any(joint.name == BASE for joint in tree.joints):
        problem = f"this name is taken by the {base} base; rename the joint"
        raise ModelError(problem, field=f"joint[{BASE}]")
    return [*moving, BASE]


def _pinocchio_model(tree: Tree, base: str) -> pin.Model:
    model = pin.Model()
    number = 0
    if base != "fixed":
        number = model.addJoint(0, BASES[base].pinocchio(), pin.SE3.Identity(), BASE)
    _add_link(model, tree.links[tree.root], number, pin.SE3.Identity(), 0)
    followed = {mimic.of for _, mimic in tree.mimics}
    for joint in tree.joints:
        parent = body_frame(model, joint.parent)
        number = model.frames[parent].parentJoint
        placement = model.frames[parent].placement * pin.SE3(joint.R, joint.t)
        if joint.kind != "fixed":
            turns = joint.kind == "revolute" and not joint.mimic and joint.name not in followed
            kind = JOINTS["continuous" if turns else joint.kind]
            number = model.addJoint(number, kind.model(joint.axis), placement, joint.name)
            placement = pin.SE3.Identity()
        _add_link(model, tree.links[joint.child], number, placement, parent)
    for joint, mimic in tree.mimics:
        leader = model.getJointId(mimic.of)
        how = mimic.multiplier, mimic.offset
        model = pin.transformJointIntoMimic(model, leader, model.getJointId(joint.name), *how)
    return model


def _add_link(
    model: pin.Model, link: TreeLink, joint: int, placement: pin.SE3, parent: int
) -> None:
    model.appendBodyToJoint(joint, link_inertia(link), placement)
    model.addBodyFrame(link.name, joint, placement, parent)


def _placed_shapes(tree: Tree, model: pin.Model) -> Iterator[PlacedShape]:
    """The shapes of all links, each in the frame of its own."""
    for number, link in enumerate(tree.links.values()):
        frame = model.frames[body_frame(model, link.name)].placement
        for shape in link.shapes:
            # There and back: with the last bits of runs that are recorded.
            placement = frame.actInv(frame * pin.SE3(shape.R, shape.t))
            R, t = placement.rotation, placement.translation
            yield PlacedShape(shape.name, number, R, t, shape.shape)
