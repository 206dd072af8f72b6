"""Vectors and matrices of exact numbers: arrays, on which NumPy's operators work entry by entry."""

from collections.abc import Iterable
from typing import Any, Final, TypeAlias

import numpy as np

from quasistatic_ref.lab.vectors.exact.precision import Real, number, root

Vector: TypeAlias = Any
"""An array of numbers, shape (n,)."""
Matrix: TypeAlias = Any


def vector(values: Iterable[float | Real]) -> Vector:
    """Numbers as a vector, each exactly.

    Parameters
    ----------
    values : iterable of float or number
        [any unit].
    """
    return np.array([number(x) for x in values], dtype=object)


def length(x: Vector) -> Real:
    """Length of a vector."""
    return root(x @ x)


ZERO: Final[Vector] = vector([0, 0, 0])
IDENTITY: Final[Matrix] = np.array([vector(row) for row in np.eye(3)])
