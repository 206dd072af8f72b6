"""The order in which q has the joints of a URDF."""

from collections.abc import Collection, Mapping, Sequence

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.tree import TreeJoint
from quasistatic_ref.quoting import clipped


def visiting_order(root: str, joints: Sequence[TreeJoint]) -> list[TreeJoint]:
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
    below: dict[str, list[TreeJoint]] = {}
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
                of = clipped(joint.mimic.of)
                name = clipped(joint.name)
                problem = f"{name} moves {of}, so let {of} mimic {name}"
                field = f"joint[{joint.name}].mimic"
                raise ModelError(problem, field=field, value=joint.mimic.of)
    order = []
    front = _after_waiting(below.get(root, []), waits)[::-1]
    while front:
        order.append(front.pop())
        front += _after_waiting(below.get(order[-1].child, []), waits)[::-1]
    return order


def _after_waiting(
    joints: Sequence[TreeJoint], waits: Mapping[str, Collection[str]]
) -> list[TreeJoint]:
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


def _joints_above(joint: TreeJoint, mover: Mapping[str, TreeJoint]) -> list[str]:
    """The joints from the root to a joint."""
    chain = [joint.name]
    while above := mover.get(joint.parent):
        joint = above
        chain.insert(0, joint.name)
    return chain
