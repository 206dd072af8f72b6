"""A mechanism as plain data: one tree of links, and of the joints between them.

Readers of files make it, and :meth:`Body.of_shape <quasistatic_ref.model.body.Body.of_shape>`;
:mod:`~quasistatic_ref.model.tree_model` makes pinocchio's model of it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final, NamedTuple

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import counted
from quasistatic_ref.shapes.shape import Shape
from quasistatic_ref.text.plain import Plain

MOST_COORDINATES = 250
"""Most coordinates of the joints of a tree: pinocchio takes memory with the cube of their number,
1 GiB for these; a humanoid has 60."""

BASE = "base"
"""Name of the joint of a base that moves."""
ALL = "all"
ALL_BUT_BASE = "joints"
"""Words for actuated joints."""

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
    welded : tuple of str
        Links of which the source has but the mass of all that are welded to each other.
    """

    path: Path
    text: str
    links: dict[str, TreeLink]
    joints: tuple[TreeJoint, ...]
    ignored: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    welded: tuple[str, ...] = ()

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


def is_actuated(joint: str, actuated: str | Sequence[str]) -> bool:
    """Whether a joint, or the base, is actuated by the names or the word of a body.

    Parameters
    ----------
    joint : str
        Its name, without the body's.
    actuated : sequence of str, "joints" or "all"
    """
    if actuated == ALL_BUT_BASE:
        return joint != BASE
    return actuated == ALL or joint in actuated
