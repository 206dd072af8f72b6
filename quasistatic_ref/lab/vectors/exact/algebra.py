"""Vectors and matrices of exact numbers, as plain lists."""

from collections.abc import Sequence
from typing import TypeAlias

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.precision import Real

Vector: TypeAlias = list[Real]
Matrix: TypeAlias = list[Vector]
"""Rows."""

ZERO: Vector = [fmpq(0), fmpq(0), fmpq(0)]
IDENTITY: Matrix = [[fmpq(int(i == j)) for j in range(3)] for i in range(3)]


def dot(a: Sequence[Real], b: Sequence[Real]) -> Real:
    """Scalar product a . b."""
    return sum((x * y for x, y in zip(a, b, strict=True)), fmpq(0))


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product a x b."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def add(a: Vector, b: Vector) -> Vector:
    """Sum a + b."""
    return [x + y for x, y in zip(a, b, strict=True)]


def subtract(a: Vector, b: Vector) -> Vector:
    """Difference a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def scaled(a: Vector, factor: Real) -> Vector:
    """Vector times a number."""
    return [x * factor for x in a]


def along(a: Vector, b: Vector, factor: Real) -> Vector:
    """Sum a + factor b."""
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def squared(a: Vector) -> Real:
    """Squared length a . a."""
    return dot(a, a)


def times(A: Matrix, x: Vector) -> Vector:
    """Matrix times vector, A x."""
    return [dot(row, x) for row in A]


def transposed(A: Matrix) -> Matrix:
    """Transpose A'."""
    return [list(column) for column in zip(*A, strict=True)]


def moved(R: Matrix, t: Vector, x: Vector) -> Vector:
    """Point x of a frame in its parent, R x + t."""
    return add(times(R, x), t)
