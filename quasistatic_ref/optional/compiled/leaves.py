"""Compiled functions in the place of methods, each tried on fixed inputs before it is used."""

import sys
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, Final, NamedTuple

from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.compiled import points
from quasistatic_ref.optional.compiled.library import missing, turned_off


class Leaf(NamedTuple):
    """A compiled function.

    Parameters
    ----------
    of : callable
        Of an instance: a function with the arguments of the method, whose answer is None where it
        declines.
    trials : callable
        Fixed instances, each with arguments that must be answered.
    """

    of: Callable[[Any], Callable[..., Any]]
    trials: Callable[[], list[tuple[Any, tuple[Any, ...]]]]


LEAVES: Final[Mapping[str, Leaf]] = {"Clouds.contacts": Leaf(points.contacts, points.trials)}
"""By the method in whose place each stands."""


def compiled_method(word: str, instance: Any) -> Callable[..., Any] | None:
    """The compiled function in the place of a method of an instance; None where there is none."""
    if turned_off() or missing() is not None or not is_right(word):
        return None
    return LEAVES[word].of(instance)


@cache
def is_right(word: str) -> bool:
    """Whether a compiled function has its method's bits on fixed inputs; it says if not."""
    for instance, arguments in LEAVES[word].trials():
        method = getattr(type(instance), word.partition(".")[2]).by_numpy
        if bits(LEAVES[word].of(instance)(*arguments)) != bits(method(instance, *arguments)):
            print(f"compiled code is left out: {word} has other bits", file=sys.stderr)
            return False
    return True
