"""Inertias of a URDF: an error where M_u needs them and they are no rigid body's, else a note.

M_u is the only mass matrix of the model. A link is part of it where an un-actuated joint moves the
link; there the inertia of all links that fixed joints weld together must be physically consistent:
mass > 0, positive definite, principal moments with the triangle inequality. Elsewhere moments of
inertia have no effect. A mass still has: gravity on actuated joints that are not compensated.

Links without inertia and shapes that only connect joints of links with mass are accepted: whether
M_u is definite depends on the axes of these joints, and is found from M_u itself.
"""

from collections.abc import Collection, Mapping, Sequence

import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.urdf.file import NO_INERTIA, Defect, FileLink, UrdfFile, inertia_defect


def link_inertia(link: FileLink) -> pin.Inertia:
    """The inertia of a link as written, in its frame."""
    inertia = pin.Inertia.Zero()  # with numbers, its constructor refuses what no body has
    inertia.mass = link.mass
    inertia.lever = link.com
    inertia.inertia = link.inertia
    return inertia


def checked_inertias(
    file: UrdfFile, model: pin.Model, unactuated: Collection[str], base: str
) -> tuple[str, ...]:
    """Notes on inertias that no rigid body can have and that M_u does not need.

    Parameters
    ----------
    file : UrdfFile
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
    poses = _poses(model)
    mover = _movers(file, unactuated, base)
    loaded = _loaded(file)
    notes = []
    for first, links in _rigid_groups(file).items():
        defects = [(link.name, link.defect) for link in links if link.defect is not None]
        connects = first in loaded and not any(
            link.mass or link.defect or link.collisions for link in links
        )
        if mover[first] is not None and not connects:
            heavy = [link for link in links if link.mass]
            if not heavy and links[0].defect is None:
                problem = (
                    f"is missing, but {mover[first]} moves this link: it needs a mass, or an "
                    "actuator at that joint (actuated)"
                )
                raise ModelError(problem, field=f"link[{first}].inertial")
            if NO_INERTIA in (link.defect for link in links):
                name = next(link.name for link in links if link.defect == NO_INERTIA)
                problem = f"is missing, but {mover[first]} moves this link, whose mass needs it"
                raise ModelError(problem, field=f"link[{name}].inertial.inertia")
            defect = inertia_defect(_welded(heavy, poses).inertia, max(x.digit for x in links))
            if defect is not None:
                name, (field, problem, value) = defects[0] if defects else (first, defect)
                raise ModelError(problem, field=f"link[{name}].inertial.{field}", value=value)
        notes += [
            f"link[{name}].inertial.{defect[0]}: {defect[1]}; {_accepted(defect, mover[first])}"
            for name, defect in defects
        ]
    return tuple(notes)


def _poses(model: pin.Model) -> dict[str, pin.SE3]:
    """Where each link is at position zero, in the frame of the root link."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    return {frame.name: data.oMf[i].copy() for i, frame in enumerate(model.frames)}


def _rigid_groups(file: UrdfFile) -> dict[str, list[FileLink]]:
    """The links of each rigid group, by the name of its first."""
    first = {file.root: file.root}
    groups = {file.root: [file.links[file.root]]}
    for joint in file.joints:  # parents before children
        name = first[joint.parent] if joint.kind == "fixed" else joint.child
        first[joint.child] = name
        groups.setdefault(name, []).append(file.links[joint.child])
    return groups


def _welded(links: Sequence[FileLink], poses: Mapping[str, pin.SE3]) -> pin.Inertia:
    """Links as one body, in the frame of the root link."""
    total = pin.Inertia.Zero()
    for link in links:
        total += poses[link.name].act(link_inertia(link))
    return total


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
