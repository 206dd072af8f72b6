r"""A primal-dual interior point in high precision, for steps whose cone is no polyhedron.

.. math:: \min \tfrac12 x^T H x - g^T x + \sum_j \frac{\|r_j\|^2}{2 c_j}
          \quad\text{s.t.}\quad s_j = A_j x - b_j + r_j \in Q,\qquad
          Q = \{s : s_0 \ge \|s_{1:}\|\},

one block j per contact, and one of a single row (s >= 0) per row of the user's own. A block gives
way by r_j = c_j y_j, y being the multipliers; where c_j = 0 it is rigid. Newton's method
with the scaling of Nesterov and Todd, a step towards the answer and one back to the central path by
turns (Mizuno, Todd and Ye): in 640 bits it needs no case distinction at apexes and no
regularisation. Nothing here is believed: what comes out is a guess, strictly inside of the cones,
that :mod:`~quasistatic_ref.optional.ellipsoid.enclosure` checks in balls.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import Final, NamedTuple

from flint import arb, arb_mat

from quasistatic_ref.optional.gap import inner

ITERATIONS: Final = 150
"""Grasps take 30 to 40; what takes more has no interior, or no solution."""

SHORT: Final = arb(0.99)
"""Share of the way to the boundary that a step goes."""

CENTRED: Final = arb(0.5)
"""Centrality above which a step goes for the answer; below, one goes back to the central path."""

LEAST: Final = arb(0.25)
"""Centrality that every iteration keeps. At 1e-3 an iteration back to the path loses what the one
before it gained, so that some steps are never solved; between 0.1 and 0.3 grasps take least
time."""

BACKTRACKS: Final = 60
"""Most shortenings of a step, by a quarter each, until it keeps LEAST."""

Vector = list[arb]


@dataclass(frozen=True, eq=False)
class Blocks:
    """A conic quadratic program in numbers without radius; the blocks' rows stand in one matrix.

    Parameters
    ----------
    H, g : arb_mat
        Shapes (n, n) and (n, 1); H positive definite.
    A, b : arb_mat
        Shapes (m, n) and (m, 1).
    C : arb_mat
        Shape (m, m), diagonal: the c_j of each row's block, 0 or more.
    rows : list of range
        The rows of A of each block, four or one.
    """

    H: arb_mat
    g: arb_mat
    A: arb_mat
    b: arb_mat
    C: arb_mat
    rows: list[range]

    def some(self, which: Sequence[bool]) -> "Blocks":
        """The same program with some of its blocks alone."""
        kept = [rows for rows, is_one in zip(self.rows, which, strict=True) if is_one]
        every = [i for rows in kept for i in rows]
        ends = list(accumulate(map(len, kept), initial=0))
        A, b = self.A.tolist(), self.b.tolist()
        return replace(
            self,
            A=arb_mat(len(every), self.A.ncols(), [v for i in every for v in A[i]]),
            b=arb_mat(len(every), 1, [v for i in every for v in b[i]]),
            C=diagonal([self.C[i, i] for i in every]),
            rows=[range(*ends_of) for ends_of in pairwise(ends)],
        )

    @property
    def give(self) -> list[arb]:
        """The compliance c of each block."""
        return [self.C[rows[0], rows[0]] for rows in self.rows]

    def slacks(self, x: arb_mat, y: arb_mat) -> arb_mat:
        """The slacks s, shape (m, 1), at x, with the compliance that y causes."""
        return (self.A * x - self.b + self.C * y).mid()

    def split(self, v: arb_mat) -> list[Vector]:
        """The entries of a column, shape (m, 1), by block."""
        entries = v.entries()
        return [entries[rows.start : rows.stop] for rows in self.rows]


class Pair(NamedTuple):
    """A primal and dual answer.

    Parameters
    ----------
    x, y : arb_mat
        Shapes (n, 1) and (m, 1), without radius.
    """

    x: arb_mat
    y: arb_mat


def interior_point(problem: Blocks, gap: arb) -> Pair | None:
    """An answer strictly inside of its cones, with a duality gap below `gap`; None if not reached.

    Parameters
    ----------
    problem : Blocks
        Scaled: rows, H and the answer of about one.
    gap : arb
    """
    A = problem.A
    rows_of_A = A.tolist()
    of_blocks = [arb_mat(rows_of_A[rows.start : rows.stop]) for rows in problem.rows]
    split = problem.split
    x = problem.H.solve(problem.g).mid()
    s = column(v for s_j in split((A * x - problem.b).mid()) for v in _inside(s_j))
    y = column(arb(i == rows[0]) for rows in problem.rows for i in rows)
    for _ in range(ITERATIONS):
        r_d = problem.g - problem.H * x + A.transpose() * y
        r_p = s - problem.slacks(x, y)
        work = inner(s, y).mid()
        if all(abs(v) < gap for v in (work, *r_d.entries(), *r_p.entries())):
            return Pair(x, y)
        blocks = list(zip(split(s), split(y), problem.give, strict=True))
        weights = [_softer(_inverse_scaling(s_j, y_j), c_j) for s_j, y_j, c_j in blocks]
        W = _block_diagonal(weights)
        WA = arb_mat([row for v, A_j in zip(weights, of_blocks, strict=True)
                      for row in (v * A_j).mid().tolist()])  # fmt: skip
        K = (problem.H + A.transpose() * WA).mid()
        share = arb(0) if _centrality(split(s), split(y)) > CENTRED else arb(1)
        mu = work / len(blocks)
        c = column(v for s_j, y_j, _ in blocks for v in _centred(s_j, y_j, share * mu))
        try:
            dx = K.solve((r_d + WA.transpose() * (c + r_p)).mid()).mid()
        except ZeroDivisionError:
            return None
        along = (A * dx - r_p).mid()
        dy = (W * (c - along)).mid()
        ds = (along + problem.C * dy).mid()
        ways = zip(split(s) + split(y), split(ds) + split(dy), strict=True)
        way = min(SHORT * min(_reach(v, d) for v, d in ways), arb(1)).mid()
        for _ in range(BACKTRACKS):
            s_new = (s + ds * way).mid()
            y_new = (y + dy * way).mid()
            if _centrality(split(s_new), split(y_new)) > LEAST:
                break
            way = (way * arb(0.75)).mid()
        else:
            return None
        x = (x + dx * way).mid()
        s = s_new
        y = y_new
    return None


def _centrality(s: list[Vector], y: list[Vector]) -> arb:
    """The least complementarity of a block over the mean: 1 on the central path.

    In the scaling of Nesterov and Todd s_j and y_j are one vector, whose smallest eigenvalue
    l0 - |l1| has l0^2 + |l1|^2 = s'y and l0^2 - |l1|^2 = sqrt(det s det y). Zero outside.
    """
    if not all(_det(v) > 0 and v[0] > 0 for v in s + y):
        return arb(0)
    work = [_dot(u, v) for u, v in zip(s, y, strict=True)]
    least = []
    for s_j, y_j, w in zip(s, y, work, strict=True):
        det = (_det(s_j) * _det(y_j)).sqrt()
        # (l0 - |l1|)^2 = s'y - 2 l0 |l1|, without cancellation
        eigen = det * det / (w + ((w - det) * (w + det)).nonnegative_part().sqrt())
        least.append((eigen if len(s_j) > 1 else w).mid())
    return (min(least) * len(work) / sum(work, arb(0))).mid()


def _inside(v: Vector) -> Vector:
    """A point well inside of the cone, near v."""
    return [max(v[0], length(v[1:]) + 1).mid(), *v[1:]]


def length(v: Sequence[arb]) -> arb:
    """The length of a vector [of its unit]."""
    return _dot(v, v).sqrt().mid()


def column(values: Iterable[arb]) -> arb_mat:
    """A column of numbers, shape (k, 1), without their radii [of their unit]."""
    entries = [v.mid() for v in values]
    return arb_mat(len(entries), 1, entries)


def diagonal(values: Sequence[arb]) -> arb_mat:
    """The diagonal matrix of some numbers [of their unit]."""
    return _block_diagonal([arb_mat([[v]]) for v in values])


def _block_diagonal(blocks: list[arb_mat]) -> arb_mat:
    m = sum(block.nrows() for block in blocks)
    whole = arb_mat(m, m)
    start = 0
    for block in blocks:
        k = block.nrows()
        for i in range(k):
            for j in range(k):
                whole[start + i, start + j] = block[i, j]
        start += k
    return whole


def _dot(u: Sequence[arb], v: Sequence[arb]) -> arb:
    return sum((a * b for a, b in zip(u, v, strict=True)), arb(0)).mid()


def _det(v: Sequence[arb]) -> arb:
    return (v[0] * v[0] - _dot(v[1:], v[1:])).mid()


def _centred(s: Vector, y: Vector, target: arb) -> Vector:
    """-s + target * y^-1, with y^-1 = J y / det y."""
    factor = target / _det(y)
    inverse = [y[0], *[-v for v in y[1:]]]
    return [(factor * i - v).mid() for i, v in zip(inverse, s, strict=True)]


def _inverse_scaling(s: Vector, y: Vector) -> arb_mat:
    """W^-2 of Nesterov and Todd: symmetric positive definite, with W^-2 s = y."""
    root_s = _det(s).sqrt().mid()
    root_y = _det(y).sqrt().mid()
    s_bar = [v / root_s for v in s]
    y_bar = [v / root_y for v in y]
    gamma = ((1 + _dot(s_bar, y_bar)) / 2).sqrt().mid()
    turned = [s_bar[0] + y_bar[0], *[b - a for a, b in zip(s_bar[1:], y_bar[1:], strict=True)]]
    w = [(v / (2 * gamma)).mid() for v in turned]  # J w
    eta = (root_y / root_s).mid()
    k = len(s)
    entries = [
        (eta * (2 * w[i] * w[j] - (0 if i != j else 1 if i == 0 else -1))).mid()
        for i in range(k)
        for j in range(k)
    ]
    return arb_mat(k, k, entries)


def _softer(weight: arb_mat, give: arb) -> arb_mat:
    """(W^2 + c)^-1 from W^-2, of a block that gives way."""
    if not give > 0:
        return weight
    k = weight.nrows()
    one = arb_mat([[arb(i == j) for j in range(k)] for i in range(k)])
    return (one + weight * give).solve(weight).mid()


def _reach(v: Vector, d: Sequence[arb]) -> arb:
    """How far along d the point v stays in the cone; at most a large number."""
    a = _det(d)
    c = _det(v)
    b = (v[0] * d[0] - _dot(v[1:], d[1:])).mid()
    square = (b * b - a * c).mid()
    far = arb(1 << 30)
    if square < 0:
        return far
    below = (square.sqrt() - b).mid()
    return min((c / below).mid(), far) if below > 0 else far
