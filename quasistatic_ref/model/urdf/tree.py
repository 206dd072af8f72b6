"""The tree of links and joints in a URDF file: one root, one parent each, mimics that can be."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.numbers.arrays import Array


@dataclass(frozen=True)
class Mimic:
    """A joint whose position is multiplier times that of joint `of`, plus offset [m or rad]."""

    of: str
    multiplier: float
    offset: float


@dataclass(frozen=True, eq=False)
class FileJoint(Plain):
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
    limits : tuple of (float, float) or None
        Lower and upper bound of its position, if it has one [m, rad].
    effort : float
        Largest force or torque; infinity where none is written [N, N m].
    """

    name: str
    kind: str
    parent: str
    child: str
    R: Array
    t: Array
    axis: Array
    mimic: Mimic | None
    limits: tuple[float, float] | None = None
    effort: float = math.inf


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
    if "ball" in (joint.kind, leader.kind):
        problem = "a ball joint, which has no single position, can neither mimic nor be mimicked"
        raise ModelError(problem, field=field, value=of)
    if (joint.kind == "continuous") != (leader.kind == "continuous"):
        problem = (
            "a continuous joint can only mimic, and be mimicked by, a continuous one; write "
            'type="revolute" with limits in its place'
        )
        raise ModelError(problem, field=field, value=of)
    if joint.kind == "continuous" and not joint.mimic.multiplier.is_integer():
        problem = (
            "must be a whole number, since the position of a continuous joint does not count "
            'turns; write type="revolute" with limits for both joints'
        )
        raise ModelError(problem, field=f"{field}.multiplier", value=joint.mimic.multiplier)


def visiting_order(root: str, joints: Sequence[FileJoint]) -> list[FileJoint]:
    """All joints, depth first from the root link on, those of a link in alphabetical order.

    But a joint waits for one that it, or a joint that it moves, mimics, or that moves a joint that
    is mimicked.

    Raises
    ------
    ModelError
        If a joint mimics one that it moves, or joints wait for each other.
    """
    mover = {joint.child: joint for joint in joints}
    named = {joint.name: joint for joint in joints}
    below: dict[str, list[FileJoint]] = {}
    for joint in sorted(joints, key=lambda joint: joint.name):
        below.setdefault(joint.parent, []).append(joint)
    waits: dict[str, set[str]] = {joint.name: set() for joint in joints}
    for joint in joints:
        if joint.mimic is None:
            continue
        followers = _joints_above(joint, mover)
        leaders = _joints_above(named[joint.mimic.of], mover)
        for after, before in zip(followers, leaders, strict=False):
            if after != before:
                waits[after].add(before)
                break
        else:
            if len(followers) < len(leaders):
                problem = "is a joint that this one moves; let that one mimic this one"
                field = f"joint[{joint.name}].mimic"
                raise ModelError(problem, field=field, value=joint.mimic.of)
    order = []
    front = _after_waiting(below.get(root, []), waits)[::-1]
    while front:
        order.append(front.pop())
        front += _after_waiting(below.get(order[-1].child, []), waits)[::-1]
    return order


def _after_waiting(
    joints: Sequence[FileJoint], waits: Mapping[str, Collection[str]]
) -> list[FileJoint]:
    """The joints of one link, each after those that it waits for."""
    left = {joint.name: joint for joint in joints}
    order = []
    while left:
        ready = [name for name in left if left.keys().isdisjoint(waits[name])]
        if not ready:
            problem = "joints that they move mimic joints that the others move, both ways round"
            raise ModelError(problem, field="joints", value=list(left))
        order.append(left.pop(ready[0]))
    return order


def _joints_above(joint: FileJoint, mover: Mapping[str, FileJoint]) -> list[str]:
    """The joints from the root to a joint."""
    chain = [joint.name]
    while above := mover.get(joint.parent):
        joint = above
        chain.insert(0, joint.name)
    return chain
