"""Compiled functions in the place of methods, each tried on fixed inputs before it is used."""

import sys
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, Final, NamedTuple

from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.compiled import points, sums
from quasistatic_ref.optional.compiled.library import missing, turned_off


class Leaf(NamedTuple):
    """A compiled function.

    Parameters
    ----------
    of : callable
        Of an instance: a function with the arguments of the method, whose answer is None where it
        declines; or None, if it knows nothing of this instance.
    trials : callable
        Fixed instances that it knows, each with arguments.
    """

    of: Callable[[Any], Callable[..., Any] | None]
    trials: Callable[[], Sequence[tuple[Any, tuple[Any, ...]]]]


LEAVES: Final[Mapping[str, Leaf]] = {
    "Clouds.contacts": Leaf(points.contacts, points.trials),
    "Sums.plus": Leaf(sums.plus, sums.trials_of_plus),
    "Sums.change": Leaf(sums.change, sums.trials_of_change),
}
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
        by_c = LEAVES[word].of(instance)
        answer = by_c and by_c(*arguments)
        if answer is not None and bits(answer) != bits(method(instance, *arguments)):
            print(f"compiled code is left out: {word} has other bits", file=sys.stderr)
            return False
    return True
