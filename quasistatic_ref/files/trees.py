"""Whether links and joints of a source are one tree, with mimics that can be."""

from collections.abc import Collection, Mapping, Sequence

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.tree import TreeJoint
from quasistatic_ref.quoting import suggestion


def checked_tree(
    links: Collection[str], joints: Sequence[TreeJoint]
) -> tuple[str, tuple[TreeJoint, ...]]:
    """Root link, and the joints sorted so that parents come before children.

    Raises
    ------
    ModelError
        If names repeat or dangle, a link has two parents, the links are not one tree, or a
        joint mimics what it cannot.
    """
    named: dict[str, TreeJoint] = {}
    parent_of: dict[str, TreeJoint] = {}
    for joint in joints:
        where = f"joint[{joint.name}]"
        if joint.name in named:
            raise ModelError("is the name of two joints; rename one", field=where)
        for field, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in links:
                problem = f"is not a link{suggestion(link, links)}"
                raise ModelError(problem, field=f"{where}.{field}", value=link)
        if joint.child in parent_of:
            problem = f"is already the child of joint {parent_of[joint.child].name!r}; name another"
            raise ModelError(problem, field=f"{where}.child", value=joint.child)
        named[joint.name] = parent_of[joint.child] = joint
    roots = [link for link in links if link not in parent_of]
    if len(roots) != 1:
        problem = "exactly one link must have no parent joint"
        raise ModelError(problem, field="root link", value=roots)
    children: dict[str, list[TreeJoint]] = {}
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
        problem = f"must connect these joints to the root link {roots[0]!r}"
        raise ModelError(problem, field="tree", value=loose)
    for joint in joints:
        _check_mimic(joint, named)
    return roots[0], tuple(ordered)


def _check_mimic(joint: TreeJoint, named: Mapping[str, TreeJoint]) -> None:
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


def is_own_name(name: str, every: Sequence[str]) -> bool:
    """Whether a shape's name means nothing else among the names of a tree's links and shapes."""
    return every.count(name) == 1 and not any(c in "/#*?[" or c.isspace() for c in name)
