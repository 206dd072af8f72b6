"""The XML of a URDF file: parsed without declarations, read without silent defaults.

Every reader here refuses what urdfdom would pass over: a repeated element, a misspelt
attribute, a number with a tail.
"""

from __future__ import annotations

import difflib
from collections.abc import Collection
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

import numpy as np

from quasistatic_ref.errors import ModelError, suggestion
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.text import decimal
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import LARGE

DEEPEST = 100
"""Most elements in one another; other readers of XML recurse, and end the process."""


def xml_root(text: str) -> Element:
    """Root element of a document without a DOCTYPE.

    Raises
    ------
    ModelError
        If the text is not well-formed, is nested without end, or declares a document type:
        entities of its own are never needed in a model, and can expand without bound.
    """
    builder = TreeBuilder()
    parser = expat.ParserCreate()
    parser.buffer_text = True

    def refusal(*_: object) -> None:
        problem = "a DOCTYPE is not allowed: no entity is ever expanded"
        raise ModelError(problem, field=f"line {parser.CurrentLineNumber}")

    parser.StartDoctypeDeclHandler = refusal
    depth = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            problem = f"is nested deeper than {DEEPEST} elements"
            raise ModelError(problem, field=f"line {parser.CurrentLineNumber}")
        builder.start(name, attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name)

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        problem = f"is not well-formed XML: {expat.ErrorString(error.code)}"
        raise ModelError(problem, field=f"line {error.lineno}") from None
    return builder.close()


def only_attributes(element: Element, where: str, known: Collection[str]) -> None:
    """Refuse an attribute that nothing would read, with a ModelError."""
    for name in element.attrib:
        if name not in known:
            raise ModelError(f"is unknown{suggestion(name, known)}", field=f"{where}.{name}")


def attribute(element: Element, where: str, name: str) -> str:
    """Text of an attribute; ModelError unless it is there and not blank."""
    value = element.get(name)
    if value is None or not value.strip():
        raise ModelError("is missing", field=f"{where}.{name}")
    return value


def numbers(
    element: Element,
    where: str,
    name: str,
    count: int,
    default: float | None = None,
    most: float = LARGE,
) -> Array:
    """Finite numbers in one attribute, shape (count,).

    Parameters
    ----------
    element : Element
    where : str
        Name of the element in messages.
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
    if default is not None and name not in element.attrib:
        return np.full(count, default)
    words = attribute(element, where, name).split()
    field = f"{where}.{name}"
    if len(words) != count:
        problem = f"must be {count} number{'s' if count > 1 else ''}"
        raise ModelError(problem, field=field, value=element.get(name))
    try:
        values = np.array([decimal(word) for word in words])
    except ModelError as error:
        error.field = field
        raise
    if np.abs(values).max() > most:
        raise ModelError(f"must be at most {most:g}", field=field, value=element.get(name))
    return values


def at_most_one(element: Element, where: str, tag: str) -> Element | None:
    """The child of that name, or None; two are a ModelError, since urdfdom reads the first only."""
    found = element.findall(tag)
    if len(found) > 1:
        raise ModelError("is given more than once", field=f"{where}.{tag}", value=len(found))
    return found[0] if found else None


def exactly_one(element: Element, where: str, tag: str) -> Element:
    """The only child of that name; a missing one is a ModelError."""
    found = at_most_one(element, where, tag)
    if found is None:
        raise ModelError("is missing", field=f"{where}.{tag}")
    return found


def ignored_children(element: Element, where: str, read: Collection[str]) -> list[str]:
    """Names of the children that are not read; ModelError if one looks like a misprint."""
    ignored = []
    for child in element:
        if child.tag in read:
            continue
        if child.tag.startswith("xacro:"):
            problem = "is a macro: expand the file with xacro first"
            raise ModelError(problem, field=f"{where}.{child.tag}")
        near = difflib.get_close_matches(child.tag, list(read), n=1, cutoff=0.8)
        if near:
            problem = f"is unknown; did you mean {near[0]!r}?"
            raise ModelError(problem, field=f"{where}.{child.tag}")
        name = f"{where}.{child.tag}"
        if name not in ignored:
            ignored.append(name)
    return ignored


def frame(element: Element, where: str) -> tuple[Array, Array]:
    """Rotation (3, 3) and origin (3,) [m] of the child ``origin``; the identity without one.

    R = Rz(yaw) Ry(pitch) Rx(roll), from the element's frame to that of its parent.
    """
    origin = at_most_one(element, where, "origin")
    if origin is None:
        return np.eye(3), np.zeros(3)
    where = f"{where}.origin"
    only_attributes(origin, where, ("xyz", "rpy"))
    rpy = numbers(origin, where, "rpy", 3, default=0.0)
    return rotation(rpy), numbers(origin, where, "xyz", 3, default=0.0)
