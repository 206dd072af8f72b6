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

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from flint import arb, arb_mat

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
    """A conic quadratic program in numbers without radius.

    Parameters
    ----------
    H, g : arb_mat
        Shapes (n, n) and (n, 1); H positive definite.
    A, b : list of arb_mat
        One (4 or 1, n) and one (4 or 1, 1) per block.
    give : list of arb
        The c of each block, 0 or more.
    """

    H: arb_mat
    g: arb_mat
    A: list[arb_mat]
    b: list[arb_mat]
    give: list[arb]

    def slacks(self, x: arb_mat, y: Sequence[Vector]) -> list[arb_mat]:
        """The s of each block, of which y makes some give way."""
        blocks = zip(self.A, self.b, self.give, y, strict=True)
        return [(A_j * x - b_j + _column(y_j) * c_j).mid() for A_j, b_j, c_j, y_j in blocks]


@dataclass(frozen=True, eq=False)
class Pair:
    """A primal and dual answer, each strictly inside of its cones.

    Parameters
    ----------
    x : arb_mat
    s, y : list of list of arb
        By block: s is nearly A x - b + c y, and H x - g nearly A'y.
    """

    x: arb_mat
    s: list[Vector]
    y: list[Vector]


def interior_point(problem: Blocks, gap: arb) -> Pair | None:
    """An answer whose duality gap is below `gap`, or None if that is not reached.

    Parameters
    ----------
    problem : Blocks
        Scaled: rows, H and the answer of about one.
    gap : arb
    """
    A = problem.A
    give = problem.give
    count = len(problem.A)
    x = problem.H.solve(problem.g).mid()
    s = [_inside(A_j * x - b_j) for A_j, b_j in zip(A, problem.b, strict=True)]
    y = [[arb(1), *([arb(0)] * (len(s_j) - 1))] for s_j in s]
    if not count:
        return Pair(x, s, y)
    for _ in range(ITERATIONS):
        mu = sum((_dot(u, v) for u, v in zip(s, y, strict=True)), arb(0)) / count
        r_d = problem.g - problem.H * x
        for A_j, y_j in zip(A, y, strict=True):
            r_d += A_j.transpose() * _column(y_j)
        r_p = [_column(u) - v for u, v in zip(s, problem.slacks(x, y), strict=True)]
        worst = max([abs(v) for v in r_d.entries()] + [abs(v) for r in r_p for v in r.entries()])
        if mu * count < gap and worst < gap:
            return Pair(x, s, y)
        weights = [
            _softer(_inverse_scaling(s_j, y_j), c_j)
            for s_j, y_j, c_j in zip(s, y, give, strict=True)
        ]
        weighted = [(W_j * A_j).mid() for W_j, A_j in zip(weights, A, strict=True)]
        K = problem.H
        for A_j, WA_j in zip(A, weighted, strict=True):
            K = K + A_j.transpose() * WA_j
        try:
            inverse = K.mid().inv().mid()
        except ZeroDivisionError:
            return None
        share = arb(0) if _centrality(s, y) > CENTRED else arb(1)
        c = [_centred(s_j, y_j, share * mu) for s_j, y_j in zip(s, y, strict=True)]
        right = r_d
        for WA_j, c_j, r_j in zip(weighted, c, r_p, strict=True):
            right = right + WA_j.transpose() * (c_j + r_j)
        dx = (inverse * right).mid()
        along = [(A_j * dx - r_j).mid() for A_j, r_j in zip(A, r_p, strict=True)]
        dy = [(W_j * (c_j - d_j)).mid() for W_j, c_j, d_j in zip(weights, c, along, strict=True)]
        ds = [(d_j + dy_j * k).mid() for d_j, dy_j, k in zip(along, dy, give, strict=True)]
        way = min([_reach(u, v.entries()) for u, v in zip(s + y, ds + dy, strict=True)])
        way = min(SHORT * way, arb(1)).mid()
        for _ in range(BACKTRACKS):
            s_new = [_moved(s_j, ds_j, way) for s_j, ds_j in zip(s, ds, strict=True)]
            y_new = [_moved(y_j, dy_j, way) for y_j, dy_j in zip(y, dy, strict=True)]
            if _centrality(s_new, y_new) > LEAST:
                break
            way = (way * arb(0.75)).mid()
        else:
            return None
        x = (x + dx * way).mid()
        s = s_new
        y = y_new
    return None


def _centrality(s: list[Vector], y: list[Vector]) -> arb:
    """Return the least complementarity of a block over the mean: 1 on the central path.

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


def _inside(s: arb_mat) -> Vector:
    """Return a point well inside of the cone, near s."""
    v = s.mid().entries()
    least = _dot(v[1:], v[1:]).sqrt().mid() + 1
    return [max(v[0], least).mid(), *v[1:]]


def _column(v: Sequence[arb]) -> arb_mat:
    return arb_mat(len(v), 1, list(v))


def _dot(u: Sequence[arb], v: Sequence[arb]) -> arb:
    return sum((a * b for a, b in zip(u, v, strict=True)), arb(0)).mid()


def _det(v: Sequence[arb]) -> arb:
    return (v[0] * v[0] - _dot(v[1:], v[1:])).mid()


def _moved(v: Vector, d: arb_mat, way: arb) -> Vector:
    return [(a + way * b).mid() for a, b in zip(v, d.entries(), strict=True)]


def _centred(s: Vector, y: Vector, target: arb) -> arb_mat:
    """Return -s + target * y^-1, with y^-1 = J y / det y."""
    factor = target / _det(y)
    inverse = [y[0], *[-v for v in y[1:]]]
    return arb_mat(len(s), 1, [(factor * i - v).mid() for i, v in zip(inverse, s, strict=True)])


def _inverse_scaling(s: Vector, y: Vector) -> arb_mat:
    """Return W^-2 of Nesterov and Todd: symmetric positive definite, with W^-2 s = y."""
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
    """Return (W^2 + c)^-1 from W^-2, of a block that gives way."""
    if not give > 0:
        return weight
    k = weight.nrows()
    one = arb_mat([[arb(i == j) for j in range(k)] for i in range(k)])
    return (one + weight * give).solve(weight).mid()


def _reach(v: Vector, d: Sequence[arb]) -> arb:
    """Return how far along d the point v stays in the cone; at most a large number."""
    a = _det(d)
    c = _det(v)
    b = (v[0] * d[0] - _dot(v[1:], d[1:])).mid()
    square = (b * b - a * c).mid()
    far = arb(1 << 30)
    if square < 0:
        return far
    below = (square.sqrt() - b).mid()
    return min((c / below).mid(), far) if below > 0 else far
