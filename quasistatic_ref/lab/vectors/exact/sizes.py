"""Sizes, a kind of number: where the others cancel, these add up.

What the program makes of the sizes of a case's numbers is the sum of the sizes of the terms of each
number that it answers; float64 is off by some roundings of that.
"""

from collections.abc import Callable
from fractions import Fraction
from operator import add, mul, truediv
from typing import Any

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.program import number as kinds
from quasistatic_ref.lab.vectors.exact.precision import number
from quasistatic_ref.lab.vectors.exact.rational import fraction
from quasistatic_ref.lab.vectors.trees import mapped


def _operator(of_fractions: Callable[[fmpq, fmpq], fmpq]) -> Callable[[Any, Any], Any]:
    """An operator of sizes; NumPy applies it to an array number by number."""

    def operator(one: Any, other: Any) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        return Size(of_fractions(one.value, Size(other).value))

    return operator


class Size:
    """The size of a number, or a sum of sizes.

    Parameters
    ----------
    value : float, int, fmpq or Size
    """

    def __init__(self, value: Any) -> None:
        self.value: fmpq = value.value if isinstance(value, Size) else abs(number(value))

    def __neg__(self) -> "Size":
        return self

    __add__ = __radd__ = __sub__ = __rsub__ = _operator(add)
    __mul__ = __rmul__ = _operator(mul)
    __truediv__ = _operator(truediv)


@kinds.part_of_turn.register
def _part_of_turn(like: Size, k: int, K: int) -> tuple[Size, ...]:
    return tuple(map(Size, kinds.part_of_turn(like.value, k, K)))


def sizes(case: Any) -> Any:
    """A case with the sizes of its numbers in their places."""
    return mapped(case, lambda value: Size(value) if isinstance(value, fmpq) else value)


def largest(values: Any) -> Fraction:
    """The largest of the sizes in an array, or of anything that becomes one; 0 of none."""
    sizes = [Size(x).value for x in np.ravel(np.array(values, dtype=object))]
    return fraction(max(sizes, default=fmpq(0)))
