"""Float64 arithmetic that is rounded outwards, one operation at a time."""

import math

import numpy as np

from quasistatic_ref.step.data import Array


def above(values: Array) -> Array:
    """The next float64 numbers above `values`, shape (n,) or any [-]: bounds of exact results."""
    return np.asarray(np.nextafter(values, np.inf))


def below(values: Array) -> Array:
    """The next float64 numbers below `values`, shape (n,) or any [-]."""
    return np.asarray(np.nextafter(values, -np.inf))


def up(value: float) -> float:
    """The next float64 number above a `value` [-]."""
    return math.nextafter(value, math.inf)


def down(value: float) -> float:
    """The next float64 number below a `value` [-]."""
    return math.nextafter(value, -math.inf)


def total(values: Array) -> float:
    """An upper bound of the sum of `values`, shape (n,) [-]: it is rounded once."""
    return up(math.fsum(values.tolist()))


def total_of_products(u: Array, v: Array) -> float:
    """An upper bound of u'v, each of shape (n,) [-]."""
    return total(above(u * v))
