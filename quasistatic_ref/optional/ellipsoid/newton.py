r"""Newton's method from a backend's answer, for steps whose cone is no polyhedron.

A backend's answer mostly shows which contacts j are open (y = 0), which stick (s = 0) and which
slide, :math:`s_0 = \|s_{1:}\|` with y along :math:`(1, -s_{1:}/\|s_{1:}\|)`, which is the direction
of the slip of A x - b, too. With that known y = F f, where f is y of what sticks and y_0 of what
slides, and the optimum solves smooth equations,

.. math:: H x - g - N^T f = 0, \qquad c = F^T s = 0, \qquad N = F^T A,

c being s of what sticks and :math:`s_0 - \|s_{1:}\|` of what slides, N its derivative by x. Each
iteration doubles the digits. What sticks may be held by dependent rows: the method of multipliers,
:math:`c + N\,dx + \varepsilon\,df = 0`, then finds the nearest of the many f, and loses nothing
else. Nothing here is believed: a wrong guess ends in a pair that
:mod:`~quasistatic_ref.optional.ellipsoid.enclosure` refuses.
"""

from typing import Final

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, column, diagonal, length
from quasistatic_ref.optional.ellipsoid.scaled_blocks import largest

EPSILON: Final = arb(2) ** -60
"""An iteration gains at most the 60 bits of this number; its linear systems lose as many."""

INWARDS: Final = arb(2) ** -200
"""How far a pair is moved inside of all cones: its gap is then of that size, far below the gap that
is claimed."""

SETTLED: Final = arb(2) ** -220
"""Change below which iterations end; less than INWARDS."""

ITERATIONS: Final = 12
"""From nine digits five are enough; a wrong guess of what sticks may not settle at all."""

ROUNDS: Final = 200
"""Of the search for a strictly feasible direction of all contacts."""

OPEN, STICKS, SLIDES = range(3)


def contact_states(problem: Blocks, pair: Pair) -> list[int]:
    """The state of each block (open, sticking, sliding), by the larger of two slacks."""
    states = []
    s = problem.split(problem.slacks(pair.x, pair.y))
    for s_j, y_j in zip(s, problem.split(pair.y), strict=True):
        inside_s, inside_y = (v[0] - length(v[1:]) for v in (s_j, y_j))
        if inside_s > y_j[0]:
            states.append(OPEN)
        else:
            states.append(STICKS if inside_y > s_j[0] or len(s_j) == 1 else SLIDES)
    return states


def newton_pair(problem: Blocks, near: Pair, states: list[int]) -> Pair | None:
    """A pair just inside of all cones, or None where the iterations do not settle.

    Parameters
    ----------
    problem : Blocks
        Scaled: rows, H and the answer of about one.
    near : Pair
        A backend's answer.
    states : list of int
        Of :func:`contact_states`.
    """
    closed = problem.some([state != OPEN for state in states])  # y of all others is zero
    of_closed = [state for state in states if state != OPEN]
    x = near.x
    f = column(near.y[i, 0] for i in _bearing(problem, states))
    ones = column(arb(1) for _ in f.entries())
    for _ in range(ITERATIONS):
        F, K = _linearised(closed, x, f, of_closed)
        y = (F * f).mid()
        N = (F.transpose() * closed.A).mid()
        c = F.transpose() * closed.slacks(x, y)
        give = F.transpose() * (closed.C * (F * ones))  # the diagonal of F'C F
        stiff = diagonal([1 / (v if v > 0 else EPSILON) for v in give.entries()]).mid()
        load = problem.g - problem.H * x + N.transpose() * (f - stiff * c)
        try:
            dx = (K + N.transpose() * stiff * N).mid().solve(load.mid()).mid()
        except ZeroDivisionError:
            return None
        df = (-(stiff * (c + N * dx))).mid()
        x = (x + dx).mid()
        f = (f + df).mid()
        moved = [*dx.entries(), *(v * EPSILON for v in df.entries())]
        if all(abs(v) < SETTLED for v in moved):
            F, _ = _linearised(problem, x, f, states)
            return _inwards(problem, Pair(x, (F * f).mid()), states)
    return None


def _bearing(problem: Blocks, states: list[int]) -> list[int]:
    """Unknown multipliers: all four of a contact that sticks, the first of one that slides."""
    count = {OPEN: 0, SLIDES: 1, STICKS: 4}
    return [
        i for rows, state in zip(problem.rows, states, strict=True) for i in rows[: count[state]]
    ]


def _linearised(
    problem: Blocks, x: arb_mat, f: arb_mat, states: list[int]
) -> tuple[arb_mat, arb_mat]:
    """F, where y = F f, and H with the curvature of what slides."""
    n = problem.H.nrows()
    A = problem.A.entries()
    K = problem.H
    bearing = _bearing(problem, states)
    F = arb_mat(problem.A.nrows(), len(bearing))
    for k, i in enumerate(bearing):
        F[i, k] = 1
    s = problem.split((problem.A * x - problem.b).mid())  # without what gives way
    for rows, s_j, state in zip(problem.rows, s, states, strict=True):
        if state == SLIDES:
            k = bearing.index(rows[0])
            slip = length(s_j[1:])
            u = column(v / slip for v in s_j[1:])
            for i, v in zip(rows[1:], u.entries(), strict=True):
                F[i, k] = -v
            across = arb_mat(len(rows) - 1, n, A[rows[1] * n : rows.stop * n])
            across = (across - u * (u.transpose() * across)).mid()
            K = K + across.transpose() * across * (f[k, 0] / slip)
    return F, K.mid()


def _inwards(problem: Blocks, pair: Pair, states: list[int]) -> Pair | None:
    """The pair moved inside of all cones: rigid contacts by x, others by their y."""
    m = problem.A.nrows()
    n = problem.H.nrows()
    A = np.array([float(v) for v in problem.A.entries()]).reshape(m, n)
    touching = [
        A[rows.start : rows.stop]
        for rows, c, state in zip(problem.rows, problem.give, states, strict=True)
        if state != OPEN and not c > 0
    ]
    way = _opening(touching, n)
    if way is None:
        return None
    moved = arb_mat(n, 1, way.tolist()) * INWARDS
    share = INWARDS * largest(pair.y.entries())
    slacks = problem.split(problem.slacks(pair.x, pair.y))
    y = pair.y
    blocks = zip(problem.rows, problem.give, problem.split(problem.A * moved), strict=True)
    for (rows, c, along), s_j, state in zip(blocks, slacks, states, strict=True):
        lift = share
        if state == OPEN:  # the gap grows by this times its slack, however far away it is
            lift /= max(s_j[0], arb(1))
        elif c > 0:  # more than what x takes it outwards
            lift += 2 * length(along) / c
        y[rows[0], 0] += lift
    return Pair((pair.x + moved).mid(), y.mid())


def _opening(A: list[Array], n: int) -> Array | None:
    """A displacement, shape (n,), that moves contacts of rows A well inside of their cones.

    By alternating projections of A d: to the point (1, 0, 0, 0) and the cone, and to the range.
    """
    d = np.zeros(n)
    if not A:
        return d
    starts = np.cumsum([0, *map(len, A)])[:-1]
    rows = np.concatenate(A)
    inverse = np.linalg.pinv(rows)
    inner = np.zeros(len(rows))
    inner[starts] = 1.0
    for _ in range(ROUNDS):
        short = [_projected(v) for v in np.split(inner - rows @ d, starts[1:])]
        if all(np.linalg.norm(v) < 0.5 for v in short):  # inner is 0.7 inside
            return d
        d = d + inverse @ np.concatenate(short)
    return None


def _projected(z: Array) -> Array:
    """The point of the cone that is nearest to z."""
    slip = float(np.linalg.norm(z[1:]))
    if z[0] >= slip:
        return z
    if z[0] <= -slip:
        return np.zeros_like(z)
    return np.asarray((z[0] + slip) / 2 * np.append(1.0, z[1:] / slip))
