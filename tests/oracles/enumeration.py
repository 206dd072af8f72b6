"""Convex programs in fractions by enumeration: each set of rows is tried as equations.

Minimise 1/2 x'Px + q'x subject to a_i x <= h_i, the first e rows being equations. The optimum of
least norm is that of the affine set on which the rows that hold it are equations, and the cost is
balanced by them; so it is the best of the candidates that satisfy all rows. A program is unbounded
if it is feasible and q falls along a direction that P and the rows leave free, within a box.
"""

from fractions import Fraction
from itertools import chain, combinations

import numpy as np

from tests.oracles.rational_kkt import exact


def solutions(M, right):
    """A solution of M z = right and a basis of those of M z = 0, by elimination; None if none."""
    rows, n = np.column_stack([M, right]), M.shape[1]
    pivots = []
    for j in range(n):
        k = len(pivots)
        found = next((i for i in range(k, len(rows)) if rows[i, j]), None)
        if found is not None:
            rows[[k, found]] = rows[[found, k]]
            rows[k] = rows[k] / rows[k, j]
            others = [i for i in range(len(rows)) if i != k]
            rows[others] = rows[others] - np.outer(rows[others, j], rows[k])
            pivots.append(j)
    if any(rows[len(pivots) :, -1]):
        return None
    z = exact(np.zeros(n))
    z[pivots] = rows[: len(pivots), -1]
    free = [j for j in range(n) if j not in pivots]
    basis = exact(np.zeros((n, len(free))))
    for k, j in enumerate(free):
        basis[j, k] = Fraction(1)
        basis[pivots, k] = -rows[: len(pivots), j]
    return z, basis


def least_norm(M, right, n):
    """The z of M z = right whose first n entries have the least norm; None if there is no z."""
    found = solutions(M, right)
    if found is None:
        return None
    z, basis = found
    part = basis[:n]
    w, _ = solutions(part.T @ part, -(part.T @ z[:n]))
    return z[:n] + part @ w


def optimum(P, q, a, h, e):
    """The optimum of least norm, ``"unbounded"``, or None if there is no feasible x."""
    none = exact(np.zeros(P.shape))
    if best(none, exact(np.zeros(len(q))), a, h, e) is None:
        return None
    eye, one = exact(np.eye(len(q))), exact(np.ones(2 * len(q)))
    cone = np.concatenate([P, a[:e], a[e:], eye, -eye])
    sides = np.append(exact(np.zeros(len(P) + len(h))), one)
    if q @ best(none, q, cone, sides, len(P) + e) < 0:
        return "unbounded"
    return best(P, q, a, h, e)


def best(P, q, a, h, e):
    """The best of all candidates of a program that is not unbounded; None if none is feasible."""
    n, kept = len(q), []
    signed = range(e, len(h))
    for some in chain.from_iterable(combinations(signed, k) for k in range(n + 1)):
        W = [*range(e), *some]
        zero = exact(np.zeros((len(W), len(W))))
        M = np.block([[P, a[W].T], [a[W], zero]])
        x = least_norm(M, np.append(-q, h[W]), n)
        if x is None:
            continue
        slack = h - a @ x
        if not any(slack[:e]) and min(slack, default=0) >= 0:
            kept.append((x @ P @ x / 2 + q @ x, x @ x, [*x]))
    return np.array(min(kept)[2], dtype=object) if kept else None
