"""What examples share: what they return, and scenes drawn in part."""

from collections.abc import Sequence
from dataclasses import replace

from quasistatic_ref.optional.show.figures.moments import Moment

Numbers = dict[str, float]
"""What an example came to: a quantity with its unit in brackets -> its value."""


def only(of: Moment, words: Sequence[str], contacts: Sequence[int]) -> Moment:
    """A moment with the shapes whose names have one of some words, and with some contacts."""
    shapes = tuple(shape for shape in of.shapes if any(word in shape.name for word in words))
    return replace(of, shapes=shapes, contacts=tuple(of.contacts[j] for j in contacts))
