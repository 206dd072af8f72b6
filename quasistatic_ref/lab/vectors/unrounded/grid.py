"""Numbers of the unrounded step: multiples of 2^-320, with 96 decimal places behind the point.

Roots, sines and quotients have no end; each is taken as the nearest multiple of 2^-320, and stays
one of these multiples from the mechanism to q+. Sums and products of such numbers are exact, so
that every comparison has an answer; what float64 writes is a multiple already. A difference
quotient over 2 * 2^-100 thus keeps more than 60 decimal places.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from flint import ctx, fmpq

from quasistatic_ref.lab.vectors.exact.precision import Real, number, rational_near

BITS = 320
"""Places behind the binary point."""
PRECISION = BITS + 96
"""Bits of a ball on the way to the grid."""
SMALL = fmpq(1, 1 << 200)
"""What is smaller counts as 0: it comes from numbers that were moved to the grid."""
STEP = fmpq(1, 1 << 100)
"""Of a central difference: 8e-31; its square is what the quotient is off by."""
OTHER_STEP = fmpq(3, 1 << 98)
"""A second one, to prove the digits."""


def _on_grid(x: Real) -> fmpq:
    exact = rational_near(number(x))
    p = int(exact.p)
    q = int(exact.q)
    return fmpq(((p << (BITS + 1)) + q) // (2 * q), 1 << BITS)


on_grid: Callable[[Any], Any] = np.frompyfunc(_on_grid, 1, 1)
"""The nearest multiple of 2^-320 of a number, or of each of an array; of a ball, of its middle."""


def exact_or_on_grid(x: Real) -> Real:
    """A rational number as it is: poses of floating bases are; a ball on the grid."""
    return x if isinstance(x, fmpq | int) else on_grid(x)


def is_small(x: fmpq) -> bool:
    """Whether a number of the grid counts as 0."""
    return bool(abs(x) < SMALL)


def working_precision() -> AbstractContextManager[object]:
    """The precision in which balls are made before they are moved to the grid: a context."""
    context: AbstractContextManager[object] = ctx.workprec(PRECISION)
    return context
