r"""The points at which some rows hold and the cost is balanced by their multipliers, exactly.

On independent rows W of a block, :math:`P x + q = A_W^T y` and :math:`A_W x + c_W = 0`. Bounds of
W are substituted. Directions that P and W leave free are those of N: the points are x + N w. One
linear system is left, whose numbers are whole, or balls where most of a dense P is left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import cached_property
from typing import Any, Final, TypeVar, cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.form import UNDERFLOW, UNIT
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import all_nearest, nearest, working_precision
from quasistatic_ref.optional.qp.block import Block, Convex, Sparse, Unlucky, shortest

Result = TypeVar("Result")

BITS: Final = 128
"""Of balls: what they leave undecided is decided in whole numbers."""
MANY_UNKNOWNS: Final = 40
"""Unknowns from which a dense system is solved in balls first."""


class Undecided(Exception):
    """A ball holds zero, or numbers of different rounding."""


def sign(v: Any) -> int:
    """The sign of a number; Undecided of a ball that holds zero."""
    if isinstance(v, arb) and v.contains(0) and not v.is_zero():
        raise Undecided
    return int(v > 0) - int(v < 0)


class Face:
    """A face: rows W as equations, and the point of least cost that satisfies them.

    Parameters
    ----------
    block : Block
    convex : Convex
        The block's cost where something can move.
    W : sequence of int
    balls : bool
        Whether to solve in balls, of a positive definite P.

    Attributes
    ----------
    X, d : list, number
        x times d, and d > 0, at which free coordinates are zero.
    Y : dict of int to number
        Of each row of W its multiplier times d, the block's unit over that of the row.
    N : list of list of fmpz
        Directions that are free, each of n whole numbers.
    balanced : bool
        Whether free coordinates have no cost that W leaves.

    Raises
    ------
    Unlucky
        If the modular choice of free coordinates was none.
    """

    X: list[Any]
    d: Any
    Y: dict[int, Any]
    N: list[list[fmpz]]

    def __init__(
        self, block: Block, convex: Convex, W: Sequence[int], *, balls: bool = False
    ) -> None:
        self.block, self.convex, self.W = block, convex, [*W]
        bounds, self.general, _ = block.split(W)
        self.free = [] if convex.definite else block.free_coordinates(W, convex.P)
        self.fixed = {
            j: (i, -block.row(i).side * block.row(i).entries[j]) for j, i in bounds.items()
        }
        taken = {*self.free, *self.fixed}
        self.rest = [j for j in range(block.n) if j not in taken]
        if balls:
            self._solve_in_balls()
        else:
            self._solve()
        self._balance()

    def _system(self) -> tuple[list[list[fmpz]], list[list[fmpz]]]:
        """P on the coordinates that are left, and the other rows of W on them."""
        rows = [self.block.row(i).entries for i in self.general]
        lines = [self.block.P[j] for j in self.rest]
        of_P, of_A = (
            [[entries.get(k, fmpz(0)) for k in self.rest] for entries in some]
            for some in (lines, rows)
        )
        return of_P, of_A

    def _right_sides(self, held: dict[int, Any], common: Any) -> list[Any]:
        """What substituted coordinates and constants leave to the rest, times `common`."""
        block = self.block

        def moved(entries: Sparse) -> Any:
            return sum((v * held[k] for k, v in entries.items() if k in held), 0 * common)

        of_x = [-block.q[j] * common - moved(block.P[j]) for j in self.rest]
        rows = map(block.row, self.general)
        return of_x + [-row.side.p * common - moved(row.entries) for row in rows]

    def _solve(self) -> None:
        """In whole numbers, with a right side for the point and each free direction."""
        block, r = self.block, len(self.rest)
        common = fmpz(1)
        for _, v in self.fixed.values():
            common = common.lcm(v.q)
        held = {j: (v * common).p for j, (_, v) in self.fixed.items()}
        of_P, of_A = self._system()
        size = r + len(of_A)
        K = [[*row, *(-a[t] for a in of_A)] for t, row in enumerate(of_P)]
        K += [[*a, *[fmpz(0)] * len(of_A)] for a in of_A]
        sides = [self._right_sides(held, common)]
        lines = [block.P[j] for j in self.rest] + [block.row(i).entries for i in self.general]
        sides += [[-line.get(j, fmpz(0)) for line in lines] for j in self.free]
        columns: list[list[fmpz]] = [[] for _ in sides]
        denominator = fmpz(1)
        if size:
            right = fmpz_mat(len(sides), size, [v for side in sides for v in side]).transpose()
            try:
                solution = cast("fmpq_mat", fmpz_mat(K).solve(right))
            except ZeroDivisionError:
                raise Unlucky from None
            numerators, denominator = solution.numer_denom()
            columns = numerators.transpose().tolist()
        self.d = denominator * common
        at: dict[int, Any] = dict(zip(self.rest, columns[0], strict=False))
        self.X = [at[j] if j in at else held.get(j, fmpz(0)) * denominator for j in range(block.n)]
        self.Y = dict(zip(self.general, columns[0][r:], strict=True))
        self.N = [
            self._direction(j, column, denominator)
            for j, column in zip(self.free, columns[1:], strict=True)
        ]

    def _direction(self, free: int, column: list[fmpz], denominator: fmpz) -> list[fmpz]:
        """A direction in whole numbers without a common factor, proved to be free."""
        entries = dict(zip(self.rest, column, strict=False)) | {free: denominator}
        whole = shortest([entries.get(j, fmpz(0)) for j in range(self.block.n)])
        rows = [*self.convex.P, *(self.block.row(i).entries for i in self.W)]
        if any(along(row, whole) for row in rows):
            raise Unlucky
        return whole

    def _solve_in_balls(self) -> None:
        """By multipliers: A P^-1 A' y = -c - A P^-1 (-q), of the coordinates that are left."""
        held = {j: arb(v) for j, (_, v) in self.fixed.items()}
        r, g = len(self.rest), len(self.general)
        of_P, of_A = self._system()
        right = self._right_sides(held, arb(1))
        A = arb_mat(g, r, [v for row in of_A for v in row])
        first, last = arb_mat(r, 1, right[:r]), arb_mat(g, 1, right[r:])
        columns = [[*(a[t] for a in of_A), right[t]] for t in range(r)]
        try:
            solved = arb_mat(of_P).solve(arb_mat(columns)).transpose().tolist() if r else []
            moved = arb_mat(solved[:g]).transpose() if g and r else arb_mat(r, g)
            x = arb_mat(r, 1, solved[g]) if r else first
            y = (A * moved).solve(last - A * x) if g else last
        except ZeroDivisionError:
            raise Undecided from None
        at: dict[int, Any] = dict(zip(self.rest, (x + moved * y).entries(), strict=True))
        self.X = [at[j] if j in at else held[j] for j in range(self.block.n)]
        self.d = arb(1)
        self.Y = dict(zip(self.general, y.entries(), strict=True))
        self.N = []

    def _balance(self) -> None:
        """Multipliers of bounds, from what the other rows leave of the cost."""
        pull = {j: self.cost_slope(j) for j in (*self.fixed, *self.free)}
        for i in self.general:
            for j, v in self.block.row(i).entries.items():
                if j in pull:
                    pull[j] -= v * self.Y[i]
        self.balanced = not any(pull[j] for j in self.free)
        self.Y |= {i: pull[j] * self.block.row(i).entries[j] for j, (i, _) in self.fixed.items()}

    def at(self, X: Sequence[fmpz], factor: fmpz) -> Face:
        """The face at another of its points, whose d is that of this one times a factor."""
        Y = {i: v * factor for i, v in self.Y.items()}
        return self._with(X=[*X], d=self.d * factor, Y=Y)

    def without(self, rows: Sequence[int]) -> Face:
        """The face without some rows that have no multiplier; its point is the same."""
        if not rows:
            return self
        Y = {i: v for i, v in self.Y.items() if i not in {*rows}}
        return self._with(X=self.X, d=self.d, Y=Y, W=[i for i in self.W if i in Y])

    def _with(self, **changes: Any) -> Face:
        other = object.__new__(Face)
        names = ("block", "convex", "W", "N", "balanced")
        other.__dict__.update({name: getattr(self, name) for name in names} | changes)
        return other

    def cost_slope(self, j: int) -> Any:
        """Entry j of P x + q, times d."""
        return self.block.q[j] * self.d + sum(
            (v * self.X[k] for k, v in self.block.P[j].items()), 0 * self.d
        )

    def slack(self, i: int) -> Any:
        """The slack of row i, times d and the row's unit."""
        entries, side, _ = self.block.row(i)
        if isinstance(self.d, arb):
            return along(entries, self.X) + arb(side) * self.d
        return along(entries, self.X) + side * self.d

    @cached_property
    def x(self) -> Array:
        """The point, each number rounded correctly, shape (n,)."""
        return self.rounded(self.X)

    @cached_property
    def open_rows(self) -> list[int]:
        """The rows outside of W whose slacks float64 does not show to be positive."""
        block = self.block
        with np.errstate(all="ignore"):
            sizes = (np.abs(block.a) + UNDERFLOW) @ (np.abs(self.x) + UNDERFLOW) + np.abs(block.c)
            shown = block.a @ self.x + block.c > (2 * block.n + 64) * UNIT * sizes + UNDERFLOW
        shown[self.W] = True
        shown[: block.equations] = False
        return [i for i in np.flatnonzero(~shown).tolist() if i not in self.Y]

    @cached_property
    def slack_signs(self) -> dict[int, int]:
        """The exact signs of the slacks of all open rows."""
        return {i: sign(self.slack(i)) for i in self.open_rows}

    @property
    def violated(self) -> list[int]:
        """The rows that the point violates."""
        e = self.block.equations
        return [i for i, s in self.slack_signs.items() if s < 0 or (s and i < e)]

    @property
    def tight(self) -> list[int]:
        """The rows outside of W without slack at the point."""
        return [i for i, s in self.slack_signs.items() if not s]

    def rounded(self, numerators: Sequence[Any], factors: Iterable[fmpq] | None = None) -> Array:
        """Numbers times d, each over d and times a factor rounded correctly, shape (k,).

        Undecided if a number has no nearest float64 in its ball.
        """
        shares = [fmpq(1)] * len(numerators) if factors is None else [*factors]
        if isinstance(self.d, arb):
            scaled = [v if f == 1 else v * arb(f) for v, f in zip(numerators, shares, strict=True)]
            values = all_nearest(scaled)
            if values is None:
                raise Undecided
        else:
            values = [
                nearest(int(v.p * f.p), int(v.q * self.d * f.q))
                for v, f in zip(map(fmpq, numerators), shares, strict=True)
            ]
        return np.array(values, dtype=np.float64)

    @property
    def y(self) -> Array:
        """Multipliers of W, each number rounded correctly, shape (k,)."""
        factors = [self.block.row(i).unit / self.block.unit for i in self.W]
        return self.rounded([self.Y[i] for i in self.W], factors)

    @property
    def objective(self) -> Array:
        """The cost 1/2 x'Px + q'x, rounded correctly, shape (1,): half of q'x - c_W'y."""
        twice: Any = sum((v * w for v, w in zip(self.block.q, self.X, strict=True)), 0 * self.d)
        for i in self.W:
            side = self.block.row(i).side
            twice -= self.Y[i] * (arb(side) if isinstance(self.d, arb) else side)
        return self.rounded([twice], [1 / (2 * self.block.unit)])


def decided(block: Block, convex: Convex, decide: Callable[[bool], Result]) -> Result:
    """The answer of `decide` by balls where P is large and full, else modulo primes."""
    full = block.n > MANY_UNKNOWNS and 2 * sum(map(len, block.P)) > block.n**2
    if convex.definite and full:
        with suppress(Undecided), working_precision(BITS):
            return block.lucky(lambda: decide(True))
    return block.lucky(lambda: decide(False))


def along(entries: Sparse, x: Any) -> Any:
    """The product of a sparse row with numbers by coordinate; those that are missing are zero."""
    if isinstance(x, dict):
        return sum((v * x[j] for j, v in entries.items() if j in x), fmpz(0))
    return sum((v * x[j] for j, v in entries.items()), fmpz(0))
