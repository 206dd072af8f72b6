"""Where kinds of numbers differ: float64 here; others register theirs.

All else in the program is made of sums, products, quotients and comparisons, which NumPy passes on
to the numbers of an array, whatever they are. Constants are whole numbers: they mix with each kind.
"""

from functools import singledispatch

import numpy as np


@singledispatch
def root(x):
    """Square root."""
    return np.sqrt(x)


@singledispatch
def cos_sin(angle):
    """Cosine and sine."""
    return np.cos(angle), np.sin(angle)


@singledispatch
def coefficients(t):
    """Sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3, by series where they would cancel."""
    if t < 0.3:
        ratios = []
        for first in (1, 2, 3):
            term = total = 1 / np.prod(np.arange(1, first + 1))
            for k in range(first + 1, first + 16, 2):
                term *= -t * t / (k * (k + 1))
                total += term
            ratios.append(total)
        return ratios
    return [np.sin(t) / t, (1 - np.cos(t)) / t**2, (t - np.sin(t)) / t**3]


@singledispatch
def part_of_turn(like, k, K):
    """Cosine and sine of k/K of a turn: float64 numbers, of the kind that `like` is of."""
    return np.cos(2 * np.pi * k / K), np.sin(2 * np.pi * k / K)
