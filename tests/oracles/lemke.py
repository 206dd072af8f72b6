"""Strictly convex quadratic programs by Lemke's complementary pivoting, in whole numbers.

Another method than the active set: minimise 1/2 x'Px + q'x subject to a_i x <= h_i has the optimum
x = -P^-1 (q + a'z), where w = M z + r, w >= 0, z >= 0, w'z = 0 with M = a P^-1 a' and
r = h + a P^-1 q. M is positive semidefinite, so the method ends with such a z, or in a ray if there
is none (Cottle, Pang, Stone, The Linear Complementarity Problem, section 4.4). Ties are broken by
the lexicographic rule, and pivots keep whole numbers whole (Edmonds). FLINT has the numbers of the
table and of M; the z that it ends with is put into the conditions, in Python's fractions.
"""

from fractions import Fraction
from functools import cmp_to_key

import numpy as np
from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from tests.oracles.rational_kkt import exact, fractions, solution, whole


def optimum(P, q, a, h):
    """The x and z of a program in fractions; None if no x satisfies its rows."""
    by_q = solution(P, q)
    if not len(h):
        return -by_q, exact([])
    by_a = solution(P, a.T)
    z = complementary(product(a, by_a), h + a @ by_q)
    return None if z is None else (-by_q - by_a @ z, z)


def product(A, B):
    """A B by FLINT, for many entries."""
    if not A.size:
        return exact(np.zeros((len(A), B.shape[1])))
    of_A, of_B = (
        fmpq_mat([[fmpq(v.numerator, v.denominator) for v in row] for row in M]) for M in (A, B)
    )
    return np.reshape(exact(fractions((of_A * of_B).entries())), (len(A), B.shape[1]))


def optima(P, q, a, h, e):
    """All optima x_0 + Z w, of which rows A w <= b hold, as these four; None if there is none.

    P is convex where the first e rows, which are equations, leave it. The conditions of an optimum
    are complementary where w is a difference of two numbers >= 0, too. All optima have the P w and
    the q'w of one.
    """
    points = on_equations(a[:e], h[:e])
    if points is None:
        return None
    x_0, Z = points
    a, h = a[e:] @ Z, h[e:] - a[e:] @ x_0
    if not Z.shape[1]:
        return (x_0, Z, a, h) if all(v >= 0 for v in h) else None
    P, q = Z.T @ P @ Z, Z.T @ (P @ x_0 + q)
    zero = exact(np.zeros((len(h), len(h))))
    M = np.block([[P, -P, a.T], [-P, P, -a.T], [-a, a, zero]])
    z = complementary(M, np.concatenate([q, -q, h]))
    if z is None:
        return None
    w = z[: len(q)] - z[len(q) : 2 * len(q)]
    faces = np.concatenate([a, P, -P, [q]])
    return x_0, Z, faces, np.concatenate([h, P @ w, -P @ w, [q @ w]])


def nearest(points, centre):
    """The one of all points x_0 + Z w with A w <= b that is nearest to a centre, in fractions."""
    x_0, Z, A, b = points
    if not Z.shape[1]:
        return x_0
    return x_0 + Z @ optimum(Z.T @ Z, Z.T @ (x_0 - centre), A, b)[0]


def on_equations(A, b):
    """A point x_0 at which A x = b, and the columns Z that A leaves; None if there is no point."""
    n = A.shape[1]
    rows = [[*A_i, b_i] for A_i, b_i in zip(A, b, strict=True)]
    pivots = []
    for j in range(n):
        k = len(pivots)
        found = next((i for i in range(k, len(rows)) if rows[i][j]), None)
        if found is None:
            continue
        rows[k], rows[found] = rows[found], rows[k]
        rows[k] = [v / rows[k][j] for v in rows[k]]
        for i in range(len(rows)):
            if i != k:
                rows[i] = [v - rows[i][j] * w for v, w in zip(rows[i], rows[k], strict=True)]
        pivots.append(j)
    if any(row[-1] for row in rows[len(pivots) :]):
        return None
    x_0, free = exact(np.zeros(n)), [j for j in range(n) if j not in pivots]
    Z = exact(np.zeros((n, len(free))))
    for row, j in zip(rows, pivots, strict=False):
        x_0[j] = row[-1]
        Z[j] = [-row[k] for k in free]
    for t, j in enumerate(free):
        Z[j, t] = Fraction(1)
    return x_0, Z


def complementary(M, r):
    """A z >= 0 with w = M z + r >= 0 and w'z = 0; None if there is none."""
    m = len(r)
    zero = exact(np.zeros(m))
    if all(v >= 0 for v in r):
        return zero
    rows = [whole([*-M_i, r_i]) for M_i, r_i in zip(M, r, strict=True)]  # w_i in a unit of its own
    table = fmpz_mat(
        [[*(int(i == j) for j in range(m)), *row[:-1], -1, row[-1]] for i, row in enumerate(rows)]
    )
    basis = [*range(m)]
    last = fmpz(1)
    entering = z0 = 2 * m
    pivot = least(table, range(m), [1] * m)
    while True:
        leaving = basis[pivot]
        row = [table[pivot, k] for k in range(z0 + 2)]
        column = fmpz_mat([[table[i, entering]] for i in range(m)])
        sign = -1 if row[entering] < 0 else 1
        table = (table * row[entering] - column * fmpz_mat([row])) * sign / last
        for k, v in enumerate(row):
            table[pivot, k] = sign * v
        last = abs(row[entering])
        basis[pivot] = entering
        if leaving == z0:
            z = zero.copy()
            for i, variable in enumerate(basis):
                if m <= variable < z0:
                    z[variable - m] = Fraction(int(table[i, z0 + 1]), int(last))
            w = M @ z + r
            assert min(*w, *z) >= 0 == w @ z
            return z
        entering = leaving + m if leaving < m else leaving - m
        rows = [i for i in range(m) if table[i, entering] > 0]
        if not rows:
            return None  # a ray
        pivot = least(table, rows, [table[i, entering] for i in range(m)])


def least(table, rows, shares):
    """The row that is first by the lexicographic rule: its last entry, then the others, shared."""
    m = table.nrows()

    def compared(i, j):
        for k in (2 * m + 1, *range(m)):
            difference = table[i, k] * shares[j] - table[j, k] * shares[i]
            if difference:
                return -1 if difference < 0 else 1
        return 0

    return min(rows, key=cmp_to_key(compared))


def multipliers_near(point, rows, y, free=()):
    """Of all with the impulse rows'y, >= 0 outside of `free`, the multipliers nearest a point."""
    eye = exact(np.eye(len(y)))
    signed = [i for i in range(len(y)) if i not in free]
    a = np.concatenate([rows.T, -rows.T, -eye[signed]])
    side = rows.T @ y
    h = np.concatenate([side, -side, exact(np.zeros(len(signed)))])
    return optimum(eye, -point, a, h)[0]


def only_multipliers(rows, free, y):
    """Whether y is the only y with this rows'y and y_i >= 0 outside of `free`.

    Both y + s and y - s, for an s at random, have y as the nearest point of that convex set: if
    another point were in it, s would have to be at right angles to the way to it.
    """
    rng = np.random.default_rng(0)
    s = exact(rng.integers(1, 10**6, len(y)) * rng.choice([-1, 1], len(y)))
    return all(list(multipliers_near(y + way * s, rows, y, free)) == list(y) for way in (1, -1))
