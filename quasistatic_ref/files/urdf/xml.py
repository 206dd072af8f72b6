"""The XML of a URDF file: parsed without declarations, read without silent defaults.

Every reader here refuses what urdfdom would pass over: a repeated element, a misspelt
attribute, a number with a tail.
"""

import difflib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from xml.etree.ElementTree import Element

import numpy as np

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.text import decimal
from quasistatic_ref.files.xml_text import LONGEST_WORD
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.model.screw import rows
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import length
from quasistatic_ref.tolerances import LARGE

MISPRINT = 0.6
"""Similarity by which a short name is taken for a misprint of another [-], as difflib counts it."""


@dataclass(frozen=True)
class Tag:
    """An XML element with its name in messages.

    Parameters
    ----------
    element : Element
    where : str
        E.g. ``link[base].inertial``.
    unread : list of str
        Elements and attributes that nothing reads.
    notes : list of str
        What is left out, or taken in another way than it is written; both lists are shared by all
        elements that are read of it.
    """

    element: Element
    where: str
    unread: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def inner(self, element: Element, where: str) -> "Tag":
        """A child element, with its name for messages."""
        return replace(self, element=element, where=where)

    def named(self, tag: str) -> Iterator["Tag"]:
        """The children of one kind, called by their names in messages, as ``link[base]``."""
        for element in self.element.findall(tag):
            name = self.inner(element, tag).text("name")
            yield self.inner(element, f"{tag}[{name}]")

    def text(self, name: str) -> str:
        """Text of an attribute; ModelError unless it is there and not blank."""
        value = self.element.get(name)
        if value is None or not value.strip():
            raise ModelError("is missing; add it", field=f"{self.where}.{name}")
        if len(value) > LONGEST_WORD:
            problem = f"is longer than {LONGEST_WORD} characters; shorten it"
            raise ModelError(problem, field=f"{self.where}.{name}", value=value)
        return value

    def expanded(self, name: str) -> str:
        """Text of an attribute, as :meth:`text` reads it; ModelError if it holds a macro."""
        value = self.text(name)
        if "$(" in value or "${" in value:
            problem = "holds a macro: expand the file with xacro first"
            raise ModelError(problem, field=f"{self.where}.{name}", value=value)
        return value

    def numbers(
        self, name: str, count: int, default: float | None = None, most: float = LARGE
    ) -> Array:
        """Finite numbers in one attribute, shape (count,).

        Parameters
        ----------
        name : str
            The attribute.
        count : int
            How many numbers it must hold.
        default : float, optional
            Each number, where the attribute is missing; without it that is an error [its unit].
        most : float
            Largest absolute value: beyond it squares and products overflow [its unit].

        Raises
        ------
        ModelError
            If there are others, or they are no such numbers.
        """
        if default is not None and name not in self.element.attrib:
            return np.full(count, default)
        text = self.expanded(name)
        field = f"{self.where}.{name}"
        if len(text.split()) != count:
            problem = f"must be {count} number{'s' if count > 1 else ''}"
            raise ModelError(problem, field=field, value=text)
        with about_field(field):
            values = np.array([decimal(word) for word in text.split()])
        if np.abs(values).max() > most:
            raise ModelError(f"must be at most {most:g}", field=field, value=text)
        return values

    def number(self, name: str, default: float | None = None, most: float = LARGE) -> float:
        """The one number of an attribute [its unit], as :meth:`numbers` reads it.

        Parameters
        ----------
        name : str
        default : float, optional
            Where the attribute is missing [its unit].
        most : float
            Largest magnitude [its unit].
        """
        return float(self.numbers(name, 1, default, most)[0])

    def only(self, *known: str) -> None:
        """Note attributes that nothing reads; ModelError for one that looks like a misprint."""
        for name in self._unknown(list(self.element.attrib), known, MISPRINT):
            longer = [one for one in known if name.rpartition(".")[2].startswith(one)]
            if longer:  # such as rpy_deg
                raise ModelError(f"is unknown; did you mean {longer[0]!r}?", field=name)
            self.unread.append(name)

    def perhaps(self, tag: str, *attributes: str) -> "Tag | None":
        """The child of that name, with no other `attributes` where some are given; or None.

        Two are a ModelError, since urdfdom reads the first only.
        """
        children = self.element.findall(tag)
        where = f"{self.where}.{tag}"
        if len(children) > 1:
            raise ModelError("must occur only once", field=where, value=len(children))
        child = self.inner(children[0], where) if children else None
        if child is not None and attributes:
            child.only(*attributes)
        return child

    def child(self, tag: str, *attributes: str) -> "Tag":
        """The only child of that name; a missing one is a ModelError."""
        child = self.perhaps(tag, *attributes)
        if child is None:
            raise ModelError("is missing; add it", field=f"{self.where}.{tag}")
        return child

    def pass_over(self, *read: str, attributes: Sequence[str] = ()) -> None:
        """Note the children and attributes that are not read.

        Parameters
        ----------
        read : str
            Tags of the children that are read.
        attributes : sequence of str
            Those that are read.

        Raises
        ------
        ModelError
            If one that is not read looks like a misprint.
        """
        tags = [child.tag for child in self.element]
        names = [name for name in self.element.attrib if not name.startswith("xmlns")]
        unread = self._unknown(names, attributes, 0.8) + self._unknown(tags, read, 0.8)
        self.unread.extend(dict.fromkeys(unread))

    def _unknown(self, names: Sequence[str], known: Sequence[str], alike: float) -> list[str]:
        ignored = []
        for tag in [name for name in names if name not in known]:
            name = f"{self.where}.{tag}"
            if tag.startswith("xacro:"):
                raise ModelError("is a macro: expand the file with xacro first", field=name)
            near = difflib.get_close_matches(tag.lower(), known, n=1, cutoff=alike)
            if near:
                raise ModelError(f"is unknown; did you mean {near[0]!r}?", field=name)
            ignored.append(name)
        return ignored

    def frame(self) -> tuple[Array, Array]:
        """Rotation (3, 3) and origin (3,) [m] of the child ``origin``; the identity without one.

        R = Rz(yaw) Ry(pitch) Rx(roll), from the element's frame to that of its parent; or that of
        the quaternion ``quat_xyzw`` (URDF 1.2).
        """
        origin = self.perhaps("origin", "xyz", "rpy", "quat_xyzw")
        if origin is None:
            return np.eye(3), np.zeros(3)
        turn = origin.turn()
        R: Array = np.array(rows((turn / length(turn)).tolist()))
        return R, origin.numbers("xyz", 3, default=0.0)

    def turn(self) -> Array:
        """The rotation of an origin as a quaternion [x y z w] of any length, shape (4,) [-].

        Raises
        ------
        ModelError
            If it has both a quaternion and roll, pitch, yaw, or a quaternion that is zero.
        """
        if "quat_xyzw" not in self.element.attrib:
            return quaternion(self.numbers("rpy", 3, default=0.0))
        where = f"{self.where}.quat_xyzw"
        if "rpy" in self.element.attrib:
            raise ModelError("cannot stand next to rpy; leave one out", field=where)
        turn = self.numbers("quat_xyzw", 4)
        if not turn.any():
            raise ModelError("must not be zero", field=where, value=turn.tolist())
        return turn

    def position_limits(self) -> tuple[float, float] | None:
        """Lower and upper bound of a joint's ``limit`` [m, rad].

        None where both are missing; one that is missing is 0.
        """
        if not {"lower", "upper"} & self.element.attrib.keys():
            return None
        return self.number("lower", 0.0, np.inf), self.number("upper", 0.0, np.inf)
