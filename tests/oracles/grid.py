"""Numbers to 96 decimal places: multiples of 2^-320.

Roots and sines have no end; each is taken as the nearest multiple of 2^-320. Sums and products of
such numbers are exact, so that every comparison has an answer.
"""

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.vectors.exact.precision import number, rational_near
from quasistatic_ref.precision import working_precision as with_bits

BITS = 320
"""Places behind the binary point."""


def _on_grid(x):
    exact = rational_near(number(x))
    p = int(exact.p)
    q = int(exact.q)
    return fmpq(((p << (BITS + 1)) + q) // (2 * q), 1 << BITS)


on_grid = np.frompyfunc(_on_grid, 1, 1)
"""The nearest multiple of 2^-320 of a number, or of each of an array; of a ball, of its middle."""


def working_precision():
    """The precision in which balls are made before they are moved to the grid: a context."""
    return with_bits(BITS + 96)
