"""Quadratic programs in fractions, each answer proved by Python's integers: nothing of the package.

For a problem min 1/2 x'Hx - g'x subject to A x >= b with rows W that bear, the optimality
conditions are H x - A_W' lam = g, A_W x = b_W, lam > 0 and A x >= b. FLINT solves the first two,
whose solution is put into the equations here; the others are signs of fractions.
"""

import math
from fractions import Fraction

import numpy as np
from flint import fmpz_mat


def exact(values):
    """Numbers of float64 as fractions, in an array of the same shape."""
    return np.frompyfunc(Fraction, 1, 1)(np.asarray(values, dtype=object))


def fractions(values):
    """Python's fractions of FLINT's."""
    return [Fraction(int(v.p), int(v.q)) for v in values]


def solution(M, right):
    """The solution of M x = right, of one column or more, by FLINT, put into the equations here.

    Raises
    ------
    ArithmeticError
        If M is singular.
    """
    if not len(M):
        return exact(right)
    n = len(M)
    rows = np.array([whole(row) for row in np.column_stack([M, right])], dtype=object)
    found = fmpz_mat(rows[:, :n].tolist()).solve(fmpz_mat(rows[:, n:].tolist()))
    x = fractions(found.entries())
    *parts, unit = whole([*x, Fraction(1)])
    columns = np.reshape(np.array(parts, dtype=object), (n, -1))
    assert (rows[:, :n] @ columns == unit * rows[:, n:]).all()
    return exact(x).reshape(np.shape(right))


def whole(row):
    """A row times the least number that makes it whole."""
    common = math.lcm(*(v.denominator for v in row))
    return [v.numerator * (common // v.denominator) for v in row]


def on_rows(of, working):
    """The minimiser of (H, g, A, b) on A_i x = b_i of a working set, and its multipliers."""
    H, g, A, b = of
    W = list(working)
    none = np.zeros((len(W), len(W)), dtype=int)
    both = solution(np.block([[H, -A[W].T], [A[W], none]]), np.append(g, b[W]))
    return both[: len(g)], both[len(g) :]


def refutation(H, g, A, b, lam, **claims):
    """Why numbers in float64 are not the correctly rounded answer; None if they are.

    `lam` is read for which rows bear. Claims are x, net and slack.
    """
    W = np.flatnonzero(lam).tolist()
    of = exact(H), exact(g), exact(A), exact(b)
    x, on_working = on_rows(of, W)
    if min(on_working, default=1) <= 0:
        return "a multiplier is not positive"
    slack = of[2] @ x - of[3]
    if min(slack, default=0) < 0:
        return "a row is violated"
    right = {"x": x, "net": on_working @ of[2][W], "slack": slack, "lam": on_working}
    for name, said in {**claims, "lam": lam[W]}.items():
        if [float(v) for v in right[name]] != said.tolist():
            return f"{name} is not rounded correctly"
    return None
