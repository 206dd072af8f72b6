"""Quadratic programs in fractions, each answer proved by Python's integers: nothing of the package.

For a problem min 1/2 x'Hx - g'x subject to A x >= b with rows W that bear, the optimality
conditions are H x - A_W' lam = g, A_W x = b_W, lam > 0 and A x >= b. FLINT solves the first two,
whose solution is put into the equations here; the others are signs of fractions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from flint import fmpz_mat

Vector = list[Fraction]
Matrix = list[Vector]
Program = tuple[Matrix, Vector, Matrix, Vector]
"""H, g, A and b."""


def solved(M: Matrix, right: Vector) -> Vector:
    """The solution of M x = right: FLINT finds it, and here it is put into the equations.

    Raises
    ------
    ArithmeticError
        If M is singular.
    """
    if not M:
        return []
    rows = [whole([*row, value]) for row, value in zip(M, right, strict=True)]
    found = fmpz_mat([row[:-1] for row in rows]).solve(fmpz_mat([row[-1:] for row in rows]))
    x = [Fraction(int(v.p), int(v.q)) for v in found.entries()]
    *parts, unit = whole([*x, Fraction(1)])
    for *row, value in rows:
        assert sum(a * part for a, part in zip(row, parts, strict=True)) == value * unit
    return x


def whole(row: Vector) -> list[int]:
    """A row times the least number that makes it whole."""
    common = math.lcm(*(v.denominator for v in row))
    return [v.numerator * (common // v.denominator) for v in row]


def dot(u: Vector, v: Vector) -> Fraction:
    """The scalar product of two vectors."""
    return sum((a * b for a, b in zip(u, v, strict=True)), Fraction(0))


def exact(values: Any) -> Any:
    """Float64 numbers as fractions, in nested lists."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    return [exact(v) for v in values] if isinstance(values, list) else Fraction(values)


def slacks(of: Program, x: Vector) -> Vector:
    """A x - b."""
    return [dot(row, x) - b for row, b in zip(of[2], of[3], strict=True)]


def on_rows(of: Program, working: Sequence[int]) -> tuple[Vector, Vector]:
    """The minimiser on A_i x = b_i of a working set, and its multipliers."""
    H, g, A, b = of
    n = len(g)
    k = len(working)
    K = [[*H[v], *(-A[i][v] for i in working)] for v in range(n)]
    K += [[*A[i], *[Fraction(0)] * k] for i in working]
    both = solved(K, [*g, *(b[i] for i in working)])
    return both[:n], both[n:]


def proved(of: Program, working: Sequence[int]) -> tuple[Vector, Vector, Vector]:
    """The optimum, its multipliers on a working set, and all slacks.

    Raises
    ------
    ArithmeticError
        If the optimum is not that of the working set.
    """
    x, lam = on_rows(of, working)
    slack = slacks(of, x)
    if min([*lam, *slack], default=0) < 0:
        raise ArithmeticError("a multiplier or a slack is negative")
    return x, lam, slack


def refutation(
    H: np.ndarray,
    g: np.ndarray,
    A: np.ndarray,
    b: np.ndarray,
    x: np.ndarray,
    net: np.ndarray,
    slack: np.ndarray,
    lam: np.ndarray,
) -> str | None:
    """Why numbers in float64 are not the correctly rounded answer; None if they are.

    `lam` is read for which rows bear.
    """
    W = np.flatnonzero(lam).tolist()
    of = exact(H), exact(g), exact(A), exact(b)
    exact_x, exact_lam = on_rows(of, W)
    if min(exact_lam, default=1) <= 0:
        return "a multiplier is not positive"
    exact_slack = slacks(of, exact_x)
    if min(exact_slack, default=0) < 0:
        return "a row is violated"
    exact_net = [dot(exact_lam, [of[2][i][v] for i in W]) for v in range(len(g))]
    pairs = {"x": (exact_x, x), "net": (exact_net, net), "slack": (exact_slack, slack),
             "lam": (exact_lam, lam[W])}  # fmt: skip
    for name, (value, said) in pairs.items():
        if [float(v) for v in value] != said.tolist():
            return f"{name} is not rounded correctly"
    return None


def farkas_refutation(A: np.ndarray, b: np.ndarray, y: Mapping[Any, str]) -> str | None:
    """Why y, fractions by row as text, does not prove that A x >= b has no solution; else None.

    It does if y > 0, A'y = 0 and b'y > 0: then 0 = (A'y)'x >= b'y > 0 for any x.
    """
    rows = [int(i) for i in y]
    weights = [Fraction(value) for value in y.values()]
    if min(weights) <= 0:
        return "a weight is not positive"
    if any(dot(weights, exact(column)) for column in A[rows].T):
        return "A'y is not zero"
    if dot(weights, exact(b[rows])) <= 0:
        return "b'y is not positive"
    return None
