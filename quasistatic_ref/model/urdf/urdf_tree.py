"""The tree of links and joints in a URDF file: one root, one parent each, mimics that can be."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.numbers.arrays import Array

Pose = tuple[Array, Array]


@dataclass(frozen=True)
class Mimic:
    """A joint whose position is multiplier times that of joint `of`, plus offset [m or rad]."""

    of: str
    multiplier: float
    offset: float


@dataclass(frozen=True, eq=False)
class FileJoint:
    """A joint as written.

    Parameters
    ----------
    name : str
    kind : str
        ``"fixed"``, ``"revolute"``, ``"continuous"`` or ``"prismatic"``.
    parent, child : str
        Names of links.
    R, t : ndarray, shapes (3, 3) and (3,)
        Frame of the child in that of the parent at position zero [-, m].
    axis : ndarray, shape (3,)
        Unit vector in the child's frame.
    mimic : Mimic or None
    bounded : bool
        Whether its limit has a lower or an upper bound.
    """

    name: str
    kind: str
    parent: str
    child: str
    R: Array
    t: Array
    axis: Array
    mimic: Mimic | None
    bounded: bool = False


def checked_tree(
    links: Collection[str], joints: Sequence[FileJoint]
) -> tuple[str, tuple[FileJoint, ...]]:
    """Root link, and the joints sorted so that parents come before children.

    Raises
    ------
    ModelError
        If names repeat or dangle, a link has two parents, the links are not one tree, or a
        joint mimics what it cannot.
    """
    named: dict[str, FileJoint] = {}
    parent_of: dict[str, FileJoint] = {}
    for joint in joints:
        where = f"joint[{joint.name}]"
        if joint.name in named:
            raise ModelError("is the name of two joints; rename one", field=where)
        for field, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                problem = f"is not a link{suggestion(link, links)}"
                raise ModelError(problem, field=f"{where}.{field}", value=link)
        if joint.child in parent_of:
            problem = f"is already the child of joint {parent_of[joint.child].name!r}"
            raise ModelError(problem, field=f"{where}.child", value=joint.child)
        named[joint.name] = parent_of[joint.child] = joint
    roots = [link for link in links if link not in parent_of]
    if len(roots) != 1:
        problem = "exactly one link must have no parent joint"
        raise ModelError(problem, field="root link", value=roots)
    children: dict[str, list[FileJoint]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint)
    ordered = []
    front = [roots[0]]
    while front:
        here = children.get(front.pop(), [])
        ordered += here
        front += [joint.child for joint in here]
    if len(ordered) != len(joints):
        loose = sorted(set(named) - {joint.name for joint in ordered})
        problem = f"these joints are not connected to the root link {roots[0]!r}"
        raise ModelError(problem, field="tree", value=loose)
    for joint in joints:
        _check_mimic(joint, named)
    return roots[0], tuple(ordered)


def _check_mimic(joint: FileJoint, named: Mapping[str, FileJoint]) -> None:
    if joint.mimic is None:
        return
    field = f"joint[{joint.name}].mimic"
    of = joint.mimic.of
    leader = named[of]
    if leader.kind == "fixed" or leader.mimic is not None:
        problem = "must be a joint that moves by itself, neither fixed nor a mimic"
        raise ModelError(problem, field=field, value=of)
    if (joint.kind == "continuous") != (leader.kind == "continuous"):
        problem = (
            "a continuous joint can only mimic, and be mimicked by, a continuous one; write "
            'type="revolute" with limits in its place'
        )
        raise ModelError(problem, field=field, value=of)


def visiting_order(robot: Element) -> list[str]:
    """All joints, those of a link in the order in which to visit them; [] if any order will do.

    It is alphabetical, except that joints wait for a joint that they, or joints that they move,
    mimic, or that moves a joint that is mimicked.

    Raises
    ------
    ModelError
        If a joint mimics one that it moves, or joints wait for each other.
    """
    joints = {joint.attrib["name"]: joint for joint in robot.findall("joint")}
    parent = {name: _end(joint, "parent") for name, joint in joints.items()}
    mover = {_end(joint, "child"): name for name, joint in joints.items()}
    waits: dict[str, set[str]] = {name: set() for name in joints}
    moving = {name: joint for name, joint in joints.items() if joint.get("type") != "fixed"}
    for name, joint in moving.items():
        for mimic in joint.findall("mimic"):
            followers = _movers(name, parent, mover)
            leaders = _movers(mimic.attrib["joint"], parent, mover)
            for after, before in zip(followers, leaders, strict=False):
                if after != before:
                    waits[after].add(before)
                    break
            else:
                if len(followers) < len(leaders):
                    problem = "is a joint that this one moves; let that one mimic this one"
                    of = mimic.attrib["joint"]
                    raise ModelError(problem, field=f"joint[{name}].mimic", value=of)
    if all(before < after for after, others in waits.items() for before in others):
        return []
    order = []
    for link in dict.fromkeys(parent.values()):
        left = sorted(name for name in joints if parent[name] == link)
        while left:
            ready = [name for name in left if waits[name].isdisjoint(left)]
            if not ready:
                problem = "joints that they move mimic joints that the others move, both ways round"
                raise ModelError(problem, field="joints", value=left)
            order.append(ready[0])
            left.remove(ready[0])
    return order


def _end(joint: Element, end: str) -> str:
    """The parent or child link of a joint."""
    element = joint.find(end)
    assert element is not None  # files are checked before
    return element.attrib["link"]


def _movers(name: str, parent: Mapping[str, str], mover: Mapping[str, str]) -> list[str]:
    """The joints from the root to a joint."""
    chain = [name]
    while above := mover.get(parent[chain[0]]):
        chain.insert(0, above)
    return chain


def link_poses(
    root: str, joints: Sequence[FileJoint], positions: Mapping[str, float]
) -> dict[str, Pose]:
    """Pose (R, t) of every link in the frame of the root link, from the file alone.

    Parameters
    ----------
    root : str
    joints : sequence of FileJoint
        Parents before children.
    positions : mapping of str to float
        Position of every moving joint that is no mimic [m or rad].
    """
    poses: dict[str, Pose] = {root: (np.eye(3), np.zeros(3))}
    for joint in joints:
        R, t = poses[joint.parent]
        t = R @ joint.t + t
        R = R @ joint.R
        if joint.kind != "fixed":
            mimic = joint.mimic or Mimic(joint.name, 1.0, 0.0)
            position = mimic.multiplier * positions[mimic.of] + mimic.offset
            if JOINTS[joint.kind].lengths:  # its coordinate is a length: it slides
                t = t + R @ joint.axis * position
            else:
                R = R @ turn(joint.axis, position)
        poses[joint.child] = R, t
    return poses


def turn(axis: Array, angle: float) -> Array:
    """Rotation (3, 3) by an angle [rad] about a unit axis (3,), by Rodrigues' formula."""
    cross = np.cross(axis, np.eye(3)).T  # [axis x]
    R: Array = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return R
