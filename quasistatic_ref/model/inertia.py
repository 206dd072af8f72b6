"""Inertias of a tree: an error where M_u needs them and they are no rigid body's, else a note.

M_u is the only mass matrix of the model. A link is part of it where an un-actuated joint moves the
link; there the inertia of all links that fixed joints weld together must be physically consistent:
mass > 0, positive definite, principal moments with the triangle inequality. Elsewhere moments of
inertia have no effect. A mass still has: gravity on actuated joints that are not compensated.

Links without inertia and shapes that only connect joints of links with mass are accepted: whether
M_u is definite depends on the axes of these joints, and is found from M_u itself.
"""

from collections.abc import Collection

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.tree import BASE, NO_INERTIA, Defect, Tree, TreeLink
from quasistatic_ref.numbers.arrays import Array

INERTIA_TRIANGLE = 1e-6
"""How far the largest principal moment of inertia may exceed the sum of the other two, relative.

A flat plate has equality; six printed digits break it by up to 1e-6."""


def inertia_defect(inertia: Array, digit: float = 0.0) -> Defect | None:
    """Why no body can have this inertia (3, 3) about its centre of mass, or None.

    The largest moment may exceed the sum of the others by rounding: by a unit of the last printed
    digit [kg m^2], up to a tenth of it.
    """
    principal = np.linalg.eigvalsh(inertia)
    written = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    order = "(ixx iyy izz ixy ixz iyz)"
    if not principal[0] > 0:
        problem = f"must be positive definite {order}"
        if principal[0] >= -INERTIA_TRIANGLE * abs(principal[2]):
            problem += (
                "; with a radius r write m r^2/2 about the axis of a rod or disk, m r^2/4 about "
                "the diameters of a disk, 2 m r^2/5 for a point mass"
            )
        return "inertia", problem, written
    rounding = min(digit, principal[2] / 10) * (1 + INERTIA_TRIANGLE)
    if principal[2] > (principal[0] + principal[1]) * (1 + INERTIA_TRIANGLE) + rounding:
        problem = "is impossible: the largest principal moment exceeds the sum of the others"
        return "inertia", f"{problem} {order}", written
    return None


def link_inertia(link: TreeLink) -> pin.Inertia:
    """The inertia of a link, in its frame."""
    inertia = pin.Inertia.Zero()  # with numbers, its constructor refuses what no body has
    inertia.mass = link.mass
    inertia.lever = link.com
    inertia.inertia = link.inertia
    return inertia


def checked_inertias(
    tree: Tree, model: pin.Model, unactuated: Collection[str], base: str
) -> tuple[str, ...]:
    """Notes on inertias that no rigid body can have and that M_u does not need.

    Parameters
    ----------
    tree : Tree
    model : pinocchio.Model
        Made of it.
    unactuated : collection of str
        The un-actuated joints, the base's name among them where it moves and is un-actuated.
    base : str
        Kind of the base, for messages.

    Raises
    ------
    ModelError
        If an un-actuated joint moves a group of links whose inertia no rigid body can have.
    """
    notes = []
    groups: dict[int, list[TreeLink]] = {}  # the links that each joint carries as one body
    for link in tree.links.values():
        frame = model.getFrameId(link.name, pin.FrameType.BODY)
        groups.setdefault(model.frames[frame].parentJoint, []).append(link)
    for joint, links in groups.items():
        first = links[0].name
        mover = _mover(tree, model, joint, unactuated, base)
        defects = [(link.name, link.defect) for link in links if link.defect is not None]
        carries = any(model.inertias[other].mass for other in model.subtrees[joint])
        connects = carries and not any(link.mass or link.defect or link.shapes for link in links)
        if mover is not None and not connects:
            mass = model.inertias[joint].mass
            if not mass and links[0].defect is None:
                problem = (
                    f"is missing, but {mover} moves this link: it needs a mass, or an "
                    "actuator at that joint (actuated)"
                )
                raise ModelError(problem, field=f"link[{first}].inertial")
            if NO_INERTIA in (link.defect for link in links):
                name = next(link.name for link in links if link.defect == NO_INERTIA)
                problem = f"is missing, but {mover} moves this link, whose mass needs it"
                raise ModelError(problem, field=f"link[{name}].inertial.inertia")
            inertia = model.inertias[joint].inertia if mass else np.zeros((3, 3))
            defect = inertia_defect(inertia, max(link.digit for link in links))
            if defect is not None:
                name, (field, problem, value) = defects[0] if defects else (first, defect)
                raise ModelError(problem, field=f"link[{name}].inertial.{field}", value=value)
        notes += [
            f"link[{name}].inertial.{defect[0]}: {defect[1]}; {_accepted(defect, mover)}"
            for name, defect in defects
        ]
    return tuple(notes)


def _accepted(defect: Defect, mover: str | None) -> str:
    """Why a defect of a link's inertia is no error, and what it may change nevertheless."""
    if mover is not None:
        return "accepted, because the inertia of all links welded to it is that of a body"
    accepted = "accepted, because no un-actuated joint moves this link"
    lost = "its actuated joints carry no weight of it, also without gravity compensation"
    return f"{accepted}; {lost}" if defect[0] == "mass" else accepted


def _mover(
    tree: Tree, model: pin.Model, joint: int, unactuated: Collection[str], base: str
) -> str | None:
    """The nearest un-actuated joint that moves what a joint carries, in words."""
    leaders = {follower.name: mimic.of for follower, mimic in tree.mimics}
    names = [model.names[above] for above in model.supports[joint] if above]
    for name in reversed(names):
        if leaders.get(name, name) in unactuated:
            return f"the {base} base" if name == BASE and base != "fixed" else f"joint {name!r}"
    return None
