"""Answers of quadratic programs in fractions, by Python's integers alone: nothing of the package.

For a problem min 1/2 x'Hx - g'x subject to A x >= b with rows W that bear, the optimality
conditions are H x - A_W' lam = g, A_W x = b_W, lam > 0 and A x >= b. The first two are solved
without fractions by Bareiss' elimination, the others are signs of integers.
"""

from fractions import Fraction
from math import lcm

import numpy as np


def fractions_of(values):
    """Float64 numbers as fractions, an array of the same shape."""
    exact = [Fraction(v) for v in np.ravel(values).tolist()]
    return np.array(exact, dtype=object).reshape(np.shape(values))


def solution(K, v):
    """K^-1 v in fractions: each row in integers, eliminated by Bareiss' rule, then substituted."""
    rows = []
    for row, last in zip(K, v, strict=True):
        whole = [*row, last]
        common = lcm(*(entry.denominator for entry in whole))
        rows.append(np.array([int(entry * common) for entry in whole], dtype=object))
    size = len(rows)
    before = 1
    for k in range(size):
        p = next(i for i in range(k, size) if rows[i][k])
        rows[k], rows[p] = rows[p], rows[k]
        for i in range(k + 1, size):
            pivot = rows[k][k]
            factor = rows[i][k]
            rows[i][k:] = (pivot * rows[i][k:] - factor * rows[k][k:]) // before
        before = rows[k][k]
    found = np.empty(size, dtype=object)
    for k in reversed(range(size)):
        rest = sum(rows[k][j] * found[j] for j in range(k + 1, size))
        found[k] = (rows[k][size] - rest) / Fraction(rows[k][k])
    return found


def refutation(H, g, A, b, x, net, slack, lam):
    """Why numbers in float64 are not the correctly rounded answer; None if they are.

    `lam` is read for which rows bear.
    """
    W = np.flatnonzero(lam)
    n = len(g)
    k = len(W)
    H, g, A, b = (fractions_of(part) for part in (H, g, A, b))
    A_W = A[W]
    corner = fractions_of(np.zeros((k, k)))
    K = np.concatenate([np.hstack([H, -A_W.T]), np.hstack([A_W, corner])])
    both = solution(K, [*g, *b[W]])
    exact_x = both[:n]
    exact_lam = both[n:]
    if not all(value > 0 for value in exact_lam):
        return "a multiplier is not positive"
    exact_slack = A @ exact_x - b
    if not all(value >= 0 for value in exact_slack):
        return "a row is violated"
    exact_net = A_W.T @ exact_lam if k else np.zeros(n)
    pairs = {"x": (exact_x, x), "net": (exact_net, net), "slack": (exact_slack, slack),
             "lam": (exact_lam, lam[W])}  # fmt: skip
    for name, (exact, said) in pairs.items():
        if [float(value) for value in exact] != said.tolist():
            return f"{name} is not rounded correctly"
    return None


def farkas_refutation(A, b, y):
    """Why y, fractions by row as text, does not prove that A x >= b has no solution; else None.

    It does if y > 0, A'y = 0 and b'y > 0: then 0 = (A'y)'x >= b'y > 0 for any x.
    """
    rows = [int(i) for i in y]
    weights = np.array([Fraction(value) for value in y.values()], dtype=object)
    if not all(value > 0 for value in weights):
        return "a weight is not positive"
    if any(fractions_of(A[rows]).T @ weights):
        return "A'y is not zero"
    if not fractions_of(b[rows]) @ weights > 0:
        return "b'y is not positive"
    return None
