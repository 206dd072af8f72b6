"""Whether P is positive semidefinite where something can move, or a direction that costs less."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Final, NamedTuple, cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.exact.components import connected_components
from quasistatic_ref.exact.program import EXACT
from quasistatic_ref.exact.qp.block import (
    Block,
    Convex,
    Sparse,
    Unlucky,
    along,
    dense,
    shortest,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.modulo import independent_modulo
from quasistatic_ref.numbers.pivots import UNIT, surely_positive
from quasistatic_ref.numbers.precision import working_precision

DIGITS: Final = (0, 3, 20, 52)
"""Bits of a direction's largest entry, the shortest first."""
SMALL: Final = 1e-8
"""Eigenvalues over the largest that rounding may have mixed."""


class Indefinite(Exception):
    """A cost is not convex: `direction`, n whole numbers, costs less than nothing."""

    def __init__(self, direction: Sequence[fmpz]) -> None:
        super().__init__()
        self.direction = [*direction]


def convex_cost(block: Block) -> Convex:
    """The cost of a block where something can move.

    Raises
    ------
    Indefinite
        With a direction that all equations leave, and that costs less than nothing.
    """
    return block.lucky(lambda: _convex_cost(block))


def _convex_cost(block: Block) -> Convex:
    P, n = block.P, block.n
    if block.is_float and not block.is_linear and surely_positive(block.square):
        return Convex(P, block.q, block.unit, definite=True)
    try:
        return Convex(P, block.q, block.unit, semidefinite(P, block.prime) == n)
    except Indefinite:
        if not block.equations:
            raise
    start = points_of_equations(block)
    if not start.N:
        return Convex([{}] * n, [fmpz(0)] * n, fmpq(1), definite=False)
    N = fmpz_mat(start.N)
    S = (N * fmpz_mat([dense(row, range(n)) for row in P]) * N.transpose()).tolist()
    lines = [{k: v for k, v in enumerate(row) if v} for row in S]
    try:
        semidefinite(lines, block.prime)
    except Indefinite as found:
        way = N.transpose() * fmpz_mat(len(S), 1, found.direction)
        raise Indefinite(shortest(way.entries())) from None
    # In free coordinates x_j = n_j w: P and q over each n_j, in whole numbers again.
    own = [v[j] for j, v in zip(start.free, start.N, strict=True)]
    common = reduce(lambda u, v: u.lcm(v), own) ** 2 * start.d
    slope = [block.q[j] * start.d + along(P[j], start.X) for j in range(n)]
    cost, q = [dict[int, fmpz]() for _ in range(n)], [fmpz(0)] * n
    for j, row, v, w in zip(start.free, lines, start.N, own, strict=True):
        cost[j] = {start.free[k]: u * common / (w * own[k]) for k, u in row.items()}
        q[j] = sum((a * b for a, b in zip(v, slope, strict=True)), fmpz(0)) * common / (w * start.d)
    return Convex(cost, q, block.unit * common, definite=False)


class Points(NamedTuple):
    """The points X / d + N w at which all equations hold, but for those that contradict others.

    Parameters
    ----------
    X, d : list of fmpz, fmpz
    N : list of list of fmpz
        One direction for each of `free`, the only one that moves this coordinate.
    free : list of int
    """

    X: list[fmpz]
    d: fmpz
    N: list[list[fmpz]]
    free: list[int]


def points_of_equations(block: Block) -> Points:
    """The points at which equations and fixed variables hold, by elimination in whole numbers."""
    bounds, general, rest = block.split(block.independent(range(block.equations)))
    fixed = {j: -block.row(i).side * block.row(i).entries[j] for j, i in bounds.items()}
    common = reduce(lambda u, v: u.lcm(v.q), fixed.values(), fmpz(1))
    X = [(fixed.get(j, fmpq(0)) * common).p for j in range(block.n)]
    rows = []
    for i in general:
        entries, side, _ = block.row(i)
        right = -side.p * common - sum((v * X[j] for j, v in entries.items()), fmpz(0))
        rows.append([*dense(entries, rest), right])
    if not rows:
        N = [[fmpz(int(k == j)) for k in range(block.n)] for j in rest]
        return Points(X, common, N, rest)
    reduced, den, _ = fmpz_mat(rows).rref()
    lines = reduced.tolist()
    pivots = [next(t for t, v in enumerate(line) if v) for line in lines]
    X = [v * den for v in X]
    for t, line in zip(pivots, lines, strict=True):
        X[rest[t]] = line[-1]
    free = [t for t in range(len(rest)) if t not in {*pivots}]
    N = []
    for f in free:
        moved = {rest[t]: -line[f] for t, line in zip(pivots, lines, strict=True)} | {rest[f]: den}
        N.append(shortest(dense(moved, range(block.n))))
    sign = 1 if den > 0 else -1
    return Points([sign * v for v in X], abs(den) * common, N, [rest[f] for f in free])


def semidefinite(P: Sequence[Sparse], prime: int) -> int:
    """The rank of a symmetric P, which is positive semidefinite.

    An independent principal part is positive definite, and its Schur complement is zero.

    Raises
    ------
    Indefinite
    """
    pairs = [(i, j) for i, row in enumerate(P) for j in (i, *row)]
    i, j = np.array(pairs).T
    label, _ = connected_components(i, j, (len(P), len(P)))
    rank = 0
    for first in np.unique(label):
        at = np.flatnonzero(label == first).tolist()
        try:
            rank += _rank([dense(P[i], at) for i in at], prime)
        except Indefinite as found:
            entries = dict(zip(at, found.direction, strict=True))
            raise Indefinite(dense(entries, range(len(P)))) from None
    return rank


def _rank(S: list[list[fmpz]], prime: int) -> int:
    n = len(S)
    if (v := _negative(fmpz_mat(S))) is not None:
        raise Indefinite(v)
    held = independent_modulo(S, prime)
    rest = [t for t in range(n) if t not in {*held}]
    if held:
        core = fmpz_mat([[S[i][j] for j in held] for i in held])
        if (v := _not_definite(core)) is not None:
            raise Indefinite(dense(dict(zip(held, v, strict=True)), range(n)))
        if rest:
            beside = fmpz_mat([[S[i][j] for j in rest] for i in held])
            numerators, share = cast("fmpq_mat", core.solve(beside)).numer_denom()
            corner = fmpz_mat([[S[i][j] * share for j in rest] for i in rest])
            if any((corner - beside.transpose() * numerators).entries()):
                raise Unlucky
    elif any(map(any, S)):
        raise Unlucky
    return len(held)


def _cost(S: fmpz_mat, v: Sequence[fmpz]) -> fmpz:
    column = fmpz_mat(len(v), 1, [*v])
    return (column.transpose() * (S * column))[0, 0]


def _floats(S: fmpz_mat | arb_mat) -> Array:
    """A matrix over a power of two that makes its largest entry one."""
    numbers = [arb(v).man_exp() for v in S.entries()]
    most = max((int(e) + int(m).bit_length() for m, e in numbers if m), default=0)
    floats = [float(arb(m) * arb(2) ** (int(e) - most)) for m, e in numbers]
    return np.array(floats).reshape(S.nrows(), -1)


def _negative(S: fmpz_mat) -> list[fmpz] | None:
    """A v with v'Sv < 0 as float64 finds it, proved in whole numbers; None if it finds none."""
    floats = _floats(S)
    diagonal = floats.diagonal()
    scale = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    with np.errstate(over="ignore", invalid="ignore"):
        unit = floats * np.outer(scale, scale)
    if not np.isfinite(unit).all():  # far beyond the diagonal: whole numbers decide
        return None
    values, vectors = np.linalg.eigh(unit)
    some = vectors[:, values < SMALL * values[-1]] * scale[:, None]
    if not some.size:
        return None
    span = arb_mat(some.tolist())
    with working_precision(EXACT):
        small = _floats(span.transpose() * (arb_mat(S) * span))
    _, least = np.linalg.eigh(small)  # of what rounding has mixed
    v = some @ least[:, 0]
    for digits in DIGITS:
        whole = [fmpz(int(a)) for a in np.rint(np.ldexp(v / np.abs(v).max(), digits))]
        if _cost(S, whole) < 0:
            first = next(a for a in whole if a)
            return [-a for a in whole] if first < 0 else whole
    return None


def _not_definite(S: fmpz_mat) -> list[fmpz] | None:
    """A v with v'Sv < 0 of a regular S; None if it is positive definite."""
    n = S.nrows()
    if surely_positive(_floats(S) * (1 - 16 * n * UNIT * np.eye(n))):  # room for rounded entries
        return None
    x = costless(S)
    if x is None:
        return None
    pull = (S * fmpz_mat(n, 1, x)).entries()
    if _cost(S, x) < 0:
        return x
    bend = fmpq(_cost(S, pull)) / (2 * sum((v * v for v in pull), fmpz(0)))
    long = max(bend.floor(), fmpz(0)) + 1  # x costs nothing, and a little along -S x less
    return [long * v - w for v, w in zip(x, pull, strict=True)]


def costless(S: fmpz_mat) -> list[fmpz] | None:
    """An x != 0 with x'Sx <= 0; None if the symmetric S is positive definite.

    The first leading block of S whose determinant is not positive has one. With p its last column
    and B the block before, which is positive definite, it is x = [-B^-1 p; 1].
    """
    n = S.nrows()
    permutation, _, _, minors = S.fflu()  # as Bareiss: the pivots are leading minors of S
    for k in range(n):
        if permutation[k, k] != 1 or minors[k, k] <= 0:
            break
    else:
        return None
    if not k:
        return [fmpz(1), *[fmpz(0)] * (n - 1)]
    B = fmpz_mat(k, k, [S[i, j] for i in range(k) for j in range(k)])
    p = fmpz_mat(k, 1, [-S[i, k] for i in range(k)])
    numerators, denominator = cast("fmpq_mat", B.solve(p)).numer_denom()
    return [*numerators.entries(), denominator, *[fmpz(0)] * (n - k - 1)]
