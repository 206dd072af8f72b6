"""Arithmetic without rounding on arrays of float64 numbers.

A finite float64 is an integer times a power of two, and so are sums and products of such numbers:
one array of Python integers and one common exponent hold them all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.step.data import Array

Integers = NDArray[np.object_]


@dataclass(frozen=True, eq=False)
class Dyadic:
    """The numbers ``m * 2**e``.

    Parameters
    ----------
    m : ndarray of int
        Python integers of any length.
    e : int
        Their common exponent.
    """

    m: Integers
    e: int

    def __mul__(self, other: Dyadic) -> Dyadic:
        return Dyadic(self.m * other.m, self.e + other.e)

    def __rmul__(self, number: float) -> Dyadic:
        return dyadic(number) * self

    def __matmul__(self, other: Dyadic) -> Dyadic:
        return Dyadic(self.m @ other.m, self.e + other.e)

    def __add__(self, other: Dyadic) -> Dyadic:
        e = min(self.e, other.e)
        return Dyadic(self.shifted(e) + other.shifted(e), e)

    def __sub__(self, other: Dyadic) -> Dyadic:
        return self + -other

    def __neg__(self) -> Dyadic:
        return Dyadic(-self.m, self.e)

    def __getitem__(self, index: Any) -> Dyadic:
        return Dyadic(self.m[index], self.e)

    def shifted(self, e: int) -> Integers:
        """Return the integers of the same numbers at an exponent `e`, at most their own."""
        return self.m if e == self.e else self.m * (1 << (self.e - e))


def dyadic(array: Array | float) -> Dyadic:
    """The same numbers, without rounding.

    Parameters
    ----------
    array : ndarray
        Finite float64 numbers of any shape and unit [-].

    Returns
    -------
    Dyadic
        With the largest common exponent, so that the integers are short.
    """
    fraction, exponent = np.frexp(np.asarray(array, dtype=np.float64))
    m = (fraction * 2.0**53).astype(np.int64)  # |fraction| < 1: 53 bits, without rounding
    e = exponent.astype(np.int64) - 53
    trailing = np.frexp((m & -m).astype(np.float64))[1] - 1  # trailing zero bits; -1 of a zero
    m, e = m >> np.maximum(trailing, 0), e + trailing
    least = int(e[m != 0].min()) if m.any() else 0
    shift = np.where(m == 0, 0, e - least)
    integers = np.empty(m.shape, dtype=object)
    flat = [a << s for a, s in zip(m.ravel().tolist(), shift.ravel().tolist(), strict=True)]
    integers.reshape(-1)[:] = flat
    return Dyadic(integers, least)


def joined(parts: Sequence[Dyadic], axis: int = 0) -> Dyadic:
    """Arrays of the same numbers, one after the other along an axis that they have."""
    e = min((p.e for p in parts if p.m.any()), default=0)
    aligned = [p.shifted(e) if p.m.any() else p.m for p in parts]
    return Dyadic(np.concatenate(aligned, axis=axis), e)
