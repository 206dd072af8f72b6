"""A mechanism as plain data: one tree of links, and of the joints between them.

Readers of files make it, and :meth:`Body.of_shape <quasistatic_ref.model.body.Body.of_shape>`;
:mod:`~quasistatic_ref.model.tree_model` makes pinocchio's model of it.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final, NamedTuple

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.quoting import counted, suggestion
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.shape import Shape

MOST_COORDINATES = 250
"""Most coordinates of the joints of a tree: pinocchio takes memory with the cube of their number,
1 GiB for these; a humanoid has 60."""

Defect = tuple[str, str, object]
"""What is wrong with an inertia: ``"mass"`` or ``"inertia"``, the problem, the value."""

NO_INERTIA: Final[Defect] = ("inertia", "is missing", None)
"""Of a link with a mass alone."""


@dataclass(frozen=True)
class Mimic:
    """A joint whose position is multiplier times that of joint `of`, plus offset [m or rad]."""

    of: str
    multiplier: float
    offset: float


@dataclass(frozen=True, eq=False)
class TreeJoint(Plain):
    """A joint of a tree.

    Parameters
    ----------
    name : str
    kind : str
        ``"fixed"``, ``"revolute"``, ``"continuous"``, ``"prismatic"`` or ``"ball"``.
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
        Largest force or torque; infinity where none is known [N, N m].
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


class LinkShape(NamedTuple):
    """A shape of a link.

    Parameters
    ----------
    name : str
        That of its source if nothing else in the tree is called so; else ``LINK#NUMBER``.
    shape : Shape
    R, t : ndarray, shapes (3, 3) and (3,)
        Its frame in the link's [-, m].
    """

    name: str
    shape: Shape
    R: Array
    t: Array


@dataclass(frozen=True, eq=False)
class TreeLink(Plain):
    """A link of a tree.

    Parameters
    ----------
    name : str
    mass : float
        [kg]; 0 of a link without inertia.
    com : ndarray, shape (3,)
        Centre of mass in the link's frame [m].
    inertia : ndarray, shape (3, 3)
        About the centre of mass, along the link's axes [kg m^2].
    shapes : tuple of LinkShape
        Those that touch.
    defect : Defect or None
        Why no rigid body has this inertia; an error where an un-actuated joint moves the link.
    digit : float
        A unit of the last digit of its moments, as printed [kg m^2].
    """

    name: str
    mass: float
    com: Array
    inertia: Array
    shapes: tuple[LinkShape, ...]
    defect: Defect | None = None
    digit: float = 0.0


@dataclass(frozen=True, eq=False, repr=False)
class Tree(Plain):
    """A mechanism: links, and joints between them.

    Parameters
    ----------
    path : Path
        Of the file that it is read of, or another name for messages.
    text : str
        The URDF that it is read of; of another source words that only an equal one has.
    links : dict of str to TreeLink
        The root first, parents before children.
    joints : tuple of TreeJoint
        Parents before children; those that move in the order in which q has them.
    ignored : tuple of str
        What its source says and the model does not use, e.g. ``link[base].visual``.
    notes : tuple of str
        What was left out or taken in another way than it is written.
    """

    path: Path
    text: str
    links: dict[str, TreeLink]
    joints: tuple[TreeJoint, ...]
    ignored: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.path}: {counted(len(self.links), 'link')}>"

    @property
    def root(self) -> str:
        """Name of the link that has no parent."""
        return next(iter(self.links))

    @cached_property
    def moved_by(self) -> dict[str, TreeJoint]:
        """The joint above each link but the root, in the order of the links."""
        above = {joint.child: joint for joint in self.joints}
        return {link: above[link] for link in self.links if link in above}

    @property
    def mimics(self) -> Iterator[tuple[TreeJoint, Mimic]]:
        """Joints that mimic others, in the order of the links that they move."""
        for joint in self.moved_by.values():
            if joint.mimic is not None:
                yield joint, joint.mimic


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
            problem = f"is already the child of joint {parent_of[joint.child].name!r}"
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
        problem = f"these joints are not connected to the root link {roots[0]!r}"
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
