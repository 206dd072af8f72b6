"""Inertias of a URDF: an error where M_u needs them and they are no rigid body's, else a note.

M_u is the only mass matrix of the model. A link is part of it where an un-actuated joint moves the
link; there the inertia of all links that fixed joints weld together must be physically consistent:
mass > 0, positive definite, principal moments with the triangle inequality. Elsewhere moments of
inertia have no effect. A mass still has: gravity on actuated joints that are not compensated.

Links without inertia and shapes that only connect joints of links with mass are accepted: whether
M_u is definite depends on the axes of these joints, and is found from M_u itself.
"""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.urdf.urdf_file import (
    Defect,
    FileLink,
    UrdfFile,
    inertia_defect,
)
from quasistatic_ref.model.urdf.urdf_tree import Pose, link_poses, rigid_groups
from quasistatic_ref.step.arrays import Array


def group_inertias(file: UrdfFile) -> dict[str, Array]:
    """Spatial inertia (6, 6) of each rigid group as written, about the frame of its first link."""
    group = rigid_groups(file.root, file.joints)
    zero = {joint.name: 0.0 for joint in file.joints}
    poses = {
        name: pin.SE3(*pose) for name, pose in link_poses(file.root, file.joints, zero).items()
    }
    total = {first: np.zeros((6, 6)) for first in dict.fromkeys(group.values())}
    for link, first in group.items():
        m = file.links[link].mass
        c = pin.skew(file.links[link].com)
        about_com = file.links[link].inertia
        # About the link's frame, linear part first.
        inertia = np.block([[m * np.eye(3), -m * c], [m * c, about_com - m * c @ c]])
        # As a congruence, not through pinocchio's Inertia: that would divide by a mass of zero.
        X = poses[first].actInv(poses[link]).toActionMatrixInverse()
        total[first] += X.T @ inertia @ X
    return total


def checked_inertias(file: UrdfFile, unactuated: Collection[str], base: str) -> tuple[str, ...]:
    """Notes on inertias that no rigid body can have and that M_u does not need.

    Parameters
    ----------
    file : UrdfFile
    unactuated : collection of str
        The un-actuated joints, the base's name among them where it moves and is un-actuated.
    base : str
        Kind of the base, for messages.

    Raises
    ------
    ModelError
        If an un-actuated joint moves a group of links whose inertia no rigid body can have.
    """
    group = rigid_groups(file.root, file.joints)
    mover = _movers(file, unactuated, base)
    loaded = _loaded(file)
    notes = []
    poses = link_poses(file.root, file.joints, {joint.name: 0.0 for joint in file.joints})
    for first in dict.fromkeys(group.values()):
        links = [link for link in group if group[link] == first]
        welded = [file.links[link] for link in links]
        defects = [(link.name, link.defect) for link in welded]
        connects = first in loaded and not any(
            link.mass or link.defect or link.collisions for link in welded
        )
        if mover[first] is not None and not connects:
            composite = _composite(file, links, poses)
            if not composite.mass > 0 and defects[0][1] is None:
                problem = (
                    f"is missing, but {mover[first]} moves this link: it needs a mass, or an "
                    "actuator at that joint (actuated)"
                )
                raise ModelError(problem, field=f"link[{first}].inertial")
            defect = inertia_defect(composite.inertia, max(link.digit for link in welded))
            if defect is not None:
                faulty = [(name, of_link) for name, of_link in defects if of_link is not None]
                name, (field, problem, value) = faulty[0] if faulty else (first, defect)
                raise ModelError(problem, field=f"link[{name}].inertial.{field}", value=value)
        notes += [
            f"link[{name}].inertial.{of_link[0]}: {of_link[1]}; {_accepted(of_link, mover[first])}"
            for name, of_link in defects
            if of_link
        ]
    return tuple(notes)


def _loaded(file: UrdfFile) -> set[str]:
    """The links that carry a link with mass."""
    loaded: set[str] = set()
    for joint in reversed(file.joints):  # children before parents
        if file.links[joint.child].mass or joint.child in loaded:
            loaded.add(joint.parent)
    return loaded


def _accepted(defect: Defect, mover: str | None) -> str:
    """Why a defect of a link's inertia is no error, and what it may change nevertheless."""
    if mover is not None:
        return "accepted, because the inertia of all links welded to it is that of a body"
    accepted = "accepted, because no un-actuated joint moves this link"
    lost = "its actuated joints carry no weight of it, also without gravity compensation"
    return f"{accepted}; {lost}" if defect[0] == "mass" else accepted


def _movers(file: UrdfFile, unactuated: Collection[str], base: str) -> dict[str, str | None]:
    """For every link, an un-actuated joint that moves it, in words, or None."""
    root = next((name for name in unactuated if not any(j.name == name for j in file.joints)), None)
    mover: dict[str, str | None] = {file.root: f"the {base} base" if root else None}
    for joint in file.joints:
        source = joint.mimic.of if joint.mimic else joint.name
        label = f"joint {joint.name!r}" if joint.kind != "fixed" and source in unactuated else None
        mover[joint.child] = label or mover[joint.parent]
    return mover


def _composite(file: UrdfFile, links: Sequence[str], poses: Mapping[str, Pose]) -> FileLink:
    """Links welded together as one, in the frame of the root link."""
    parts = [(file.links[link], *poses[link]) for link in links if file.links[link].mass]
    mass = sum(link.mass for link, _, _ in parts)
    if not parts:
        return FileLink("", 0.0, np.zeros(3), np.zeros((3, 3)), ())
    centres = [R @ link.com + t for link, R, t in parts]
    com = sum((link.mass * c for (link, _, _), c in zip(parts, centres, strict=True)), np.zeros(3))
    com = com / mass
    inertia = np.zeros((3, 3))
    for (link, R, _), centre in zip(parts, centres, strict=True):
        d = centre - com
        inertia += R @ link.inertia @ R.T + link.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return FileLink("", mass, com, inertia, ())
