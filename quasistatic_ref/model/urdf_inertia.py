"""Where the inertias of a URDF matter, they must be those of bodies; elsewhere they are noted.

M_u is the only place where a mass matrix enters the model. So a link's inertia matters where an
un-actuated joint moves it, and there the whole that fixed joints weld together counts. The many
frames that robots give a mass of zero are then harmless.
"""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.urdf_file import FileLink, UrdfFile, inertia_defect
from quasistatic_ref.model.urdf_tree import Pose, link_poses, rigid_groups
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
        inertia = _spatial_inertia(file.links[link])
        # As a congruence, not through pinocchio's Inertia: that would divide by a mass of zero.
        X = poses[first].actInv(poses[link]).toActionMatrixInverse()
        total[first] += X.T @ inertia @ X
    return total


def checked_inertias(file: UrdfFile, free: Collection[str]) -> tuple[str, ...]:
    """Notes on inertias that no body can have, where they do not matter.

    Parameters
    ----------
    file : UrdfFile
    free : collection of str
        The un-actuated joints, the base's name among them where it moves and is un-actuated.

    Raises
    ------
    ModelError
        If an un-actuated joint moves a group of links whose inertia is that of no body.
    """
    group, mover, notes = rigid_groups(file.root, file.joints), _movers(file, free), []
    poses = link_poses(file.root, file.joints, {joint.name: 0.0 for joint in file.joints})
    for first in dict.fromkeys(group.values()):
        links = [link for link in group if group[link] == first]
        defects = [(link, file.links[link].defect) for link in links]
        if mover[first] is not None:
            whole = _whole(file, links, poses)
            if not whole.mass > 0 and defects[0][1] is None:
                problem = f"is missing, but {mover[first]} moves this link: it needs a mass"
                raise ModelError(problem, field=f"link[{first}].inertial")
            defect = inertia_defect(whole.inertia)
            if defect is not None:
                named = next(((link, d) for link, d in defects if d is not None), (first, defect))
                link, (field, problem, value) = named
                raise ModelError(problem, field=f"link[{link}].inertial.{field}", value=value)
        notes += [
            f"link[{link}].inertial.{defect[0]}: {defect[1]}; harmless here"
            for link, defect in defects
            if defect
        ]
    return tuple(notes)


def _movers(file: UrdfFile, free: Collection[str]) -> dict[str, str | None]:
    """For every link, an un-actuated joint that moves it, in words, or None."""
    root = next((name for name in free if not any(j.name == name for j in file.joints)), None)
    mover: dict[str, str | None] = {file.root: "the floating base" if root else None}
    for joint in file.joints:
        by = joint.mimic.of if joint.mimic else joint.name
        own = f"joint {joint.name!r}" if joint.kind != "fixed" and by in free else None
        mover[joint.child] = own or mover[joint.parent]
    return mover


def _whole(file: UrdfFile, links: Sequence[str], poses: Mapping[str, Pose]) -> FileLink:
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


def _spatial_inertia(link: FileLink) -> Array:
    """(6, 6) about the link's frame, linear part first."""
    m, c = link.mass, pin.skew(link.com)
    top, bottom = np.hstack([m * np.eye(3), -m * c]), np.hstack([m * c, link.inertia - m * c @ c])
    return np.vstack([top, bottom])
