"""Float64 arithmetic that is rounded outwards, one operation at a time."""

import math

import numpy as np

from quasistatic_ref.step.data import Array


def above(values: Array) -> Array:
    """The next float64 numbers above: bounds of what was rounded once, in the same unit [-]."""
    return np.asarray(np.nextafter(values, np.inf))


def below(values: Array) -> Array:
    """The next float64 numbers below, in the same unit [-]."""
    return np.asarray(np.nextafter(values, -np.inf))


def up(value: float) -> float:
    """The next float64 number above, in the same unit [-]."""
    return math.nextafter(value, math.inf)


def down(value: float) -> float:
    """The next float64 number below, in the same unit [-]."""
    return math.nextafter(value, -math.inf)


def total(values: Array) -> float:
    """An upper bound of a sum, in the same unit [-]: it is rounded once."""
    return up(math.fsum(values.tolist()))


def total_of_products(u: Array, v: Array) -> float:
    """An upper bound of u'v, each of shape (n,) [-]."""
    return total(above(u * v))
