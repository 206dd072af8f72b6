r"""Newton's method from a backend's answer, for steps whose cone is no polyhedron.

A backend's answer mostly shows which contacts j are open (y = 0), which stick (s = 0) and which
slide, :math:`s_0 = \|s_{1:}\|` with y along :math:`(1, -s_{1:}/\|s_{1:}\|)`, which is the direction
of the slip of A x - b, too. With that known the optimum solves smooth equations,

.. math:: H x - g - C^T y = 0, \qquad c(x) = 0,

c being s of what sticks and :math:`s_0 - \|s_{1:}\|` of what slides, C its derivative by x. Each
iteration doubles the digits. What sticks may be held by dependent rows: the method of multipliers,
:math:`c + C\,dx + \varepsilon\,dy = 0`, then finds the nearest of the many y, and loses nothing
else. Nothing here is believed: a wrong guess ends in a pair that
:mod:`~quasistatic_ref.optional.ellipsoid.enclosure` refuses.
"""

from typing import Final

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, Vector
from quasistatic_ref.optional.ellipsoid.scaled_blocks import largest
from quasistatic_ref.step.data import Array

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


def contact_states(problem: Blocks, x: arb_mat, y: list[Vector]) -> list[int]:
    """Which blocks are open, stick and slide, as an answer shows it: the larger of two slacks."""
    states = []
    for s_j, y_j in zip(problem.slacks(x, y), y, strict=True):
        s = np.array([float(v) for v in s_j.entries()])
        f = np.array(list(map(float, y_j)))
        inside_s, inside_f = (v[0] - np.linalg.norm(v[1:]) for v in (s, f))
        if inside_s > f[0]:
            states.append(OPEN)
        else:
            states.append(STICKS if inside_f > s[0] or len(s) == 1 else SLIDES)
    return states


def newton_pair(problem: Blocks, x: arb_mat, y: list[Vector], states: list[int]) -> Pair | None:
    """A pair just inside of all cones, or None where the iterations do not settle.

    Parameters
    ----------
    problem : Blocks
        Scaled: rows, H and the answer of about one.
    x : arb_mat
    y : list of list of arb
        A backend's answer, by block.
    states : list of int
        Of :func:`contact_states`.
    """
    for _ in range(ITERATIONS):
        K, C, c, f, give = _linearised(problem, x, y, states)
        if not c.nrows():
            dx = K.solve(problem.g - problem.H * x).mid()
            df = f
        else:
            soft = _scaled(C, give)
            load = problem.g - problem.H * x + C.transpose() * (f - _scaled(c, give))
            try:
                dx = (K + C.transpose() * soft).mid().solve(load.mid()).mid()
            except ZeroDivisionError:
                return None
            df = (-_scaled(c + C * dx, give)).mid()
        x = (x + dx).mid()
        y = _with_multipliers(problem, x, y, states, (f + df).mid().entries())
        moved = [*dx.entries(), *(v * EPSILON for v in df.entries())]
        if all(abs(v) < SETTLED for v in moved):
            return _inwards(problem, x, y, states)
    return None


def _linearised(
    problem: Blocks, x: arb_mat, y: list[Vector], states: list[int]
) -> tuple[arb_mat, arb_mat, arb_mat, arb_mat, Vector]:
    """Return H with the curvature of what slides, C, c, the multipliers of c, and c by these."""
    n = problem.H.nrows()
    K = problem.H
    rows: list[arb] = []
    c: list[arb] = []
    f: list[arb] = []
    give: list[arb] = []
    blocks = zip(problem.A, problem.b, problem.give, y, states, strict=True)
    for A_j, b_j, k, y_j, state in blocks:
        s = (A_j * x - b_j).mid()  # without what gives way
        if state == STICKS:
            rows = rows + A_j.entries()
            c = c + [v + k * w for v, w in zip(s.entries(), y_j, strict=True)]
            f = f + y_j
            give = give + [k if k > 0 else EPSILON] * len(y_j)
        elif state == SLIDES:
            u, slip = _direction(s.entries())
            normal = arb_mat(1, len(u) + 1, [arb(1), *(-v for v in u)]) * A_j
            across = arb_mat(len(u), n, A_j.entries()[n:])
            across = (across - arb_mat(len(u), 1, u) * (arb_mat(1, len(u), u) * across)).mid()
            K = K + across.transpose() * across * (y_j[0] / slip)
            rows = rows + normal.entries()
            c = [*c, s[0, 0] - slip + 2 * k * y_j[0]]  # its gap and its slip give way
            f = [*f, y_j[0]]
            give = [*give, 2 * k if k > 0 else EPSILON]
    m = len(c)
    return K.mid(), arb_mat(m, n, rows).mid(), arb_mat(m, 1, c).mid(), arb_mat(m, 1, f), give


def _scaled(rows: arb_mat, give: Vector) -> arb_mat:
    """Return rows over what they give way by."""
    m = rows.ncols()
    return arb_mat(len(give), m, [v / give[i // m] for i, v in enumerate(rows.entries())])


def _direction(s: Vector) -> tuple[Vector, arb]:
    """Return the direction of the slip s_1: and its length."""
    slip = _length(s[1:])
    return [(v / slip).mid() for v in s[1:]], slip


def _length(v: Vector) -> arb:
    return sum((a * a for a in v), arb(0)).sqrt().mid()


def _with_multipliers(
    problem: Blocks, x: arb_mat, y: list[Vector], states: list[int], f: Vector
) -> list[Vector]:
    """Return y by block from the multipliers of c."""
    found = []
    rest = iter(f)
    for A_j, b_j, y_j, state in zip(problem.A, problem.b, y, states, strict=True):
        if state == STICKS:
            found.append([next(rest) for _ in y_j])
        elif state == SLIDES:
            u, _ = _direction((A_j * x - b_j).entries())
            y_0 = next(rest)
            found.append([y_0, *((-v * y_0).mid() for v in u)])
        else:
            found.append([arb(0)] * len(y_j))
    return found


def _inwards(problem: Blocks, x: arb_mat, y: list[Vector], states: list[int]) -> Pair | None:
    """Return the pair moved inside of all cones: rigid contacts by x, others by their y."""
    rigid = [not c_j > 0 for c_j in problem.give]
    touching = [
        A_j
        for A_j, state, hard in zip(problem.A, states, rigid, strict=True)
        if hard and state != OPEN
    ]
    way = _opening(touching, problem.H.nrows())
    if way is None:
        return None
    moved = arb_mat(len(way), 1, way.tolist()) * INWARDS
    share = INWARDS * largest([v for y_j in y for v in y_j])
    inside = []
    for A_j, c_j, y_j in zip(problem.A, problem.give, y, strict=True):
        lift = share
        if c_j > 0:  # more than what x takes it outwards
            lift = share + 2 * _length((A_j * moved).entries()) / c_j
        inside.append([(y_j[0] + lift).mid(), *y_j[1:]])
    x = (x + moved).mid()
    return Pair(x, [s_j.entries() for s_j in problem.slacks(x, inside)], inside)


def _opening(A: list[arb_mat], n: int) -> Array | None:
    """Return a displacement that moves every contact well inside of its cone, in float64."""
    ends = np.cumsum([A_j.nrows() for A_j in A])
    entries = [float(v) for A_j in A for v in A_j.entries()]
    rows = np.array(entries).reshape(ends[-1] if len(ends) else 0, n)
    inverse = np.linalg.pinv(rows)
    d = np.zeros(n)
    inner = np.zeros(len(rows))
    inner[[0, *ends[:-1]] if len(ends) else []] = 1.0
    for _ in range(ROUNDS):  # alternating projections of rows d to inner + cone and to the range
        short = [_projected(v) for v in np.split(inner - rows @ d, ends[:-1])]
        if all(np.linalg.norm(v) < 0.5 for v in short):  # inner is 0.7 inside
            return d
        d = d + inverse @ np.concatenate(short)
    return None


def _projected(z: Array) -> Array:
    """Return the point of the cone that is nearest to z."""
    length = float(np.linalg.norm(z[1:]))
    if z.size == 0 or z[0] >= length:
        return z
    if z[0] <= -length:
        return np.zeros_like(z)
    return np.asarray((z[0] + length) / 2 * np.append(1.0, z[1:] / length))
