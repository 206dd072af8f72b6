r"""The points at which some rows hold and the cost is balanced by their multipliers, exactly.

On independent rows W of a block, :math:`P x + q = A_W^T y` and :math:`A_W x + c_W = 0`. Directions
that P and W leave free are those of N: the points are x + N w. Numbers are whole, or balls where
most of a dense P is left.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Any, Final, TypeVar

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz

from quasistatic_ref.exact.program import UNDERFLOW, UNIT
from quasistatic_ref.exact.qp.block import Block, Convex, Unlucky, along
from quasistatic_ref.exact.qp.kkt import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import all_nearest, nearest, working_precision

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
    M : list of dict of int to fmpq
        Of each direction v the multipliers m of P v = A_W'm: zero where P is semidefinite.
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
    M: list[dict[int, fmpq]]

    def __init__(
        self, block: Block, convex: Convex, W: Sequence[int], *, balls: bool = False
    ) -> None:
        self.block, self.convex, self.W = block, convex, [*W]
        self.free = [] if convex.definite else block.free_coordinates(W, convex.P)
        self.system = System(block, W, self.free)
        if balls:
            self._solve_in_balls()
        else:
            self._solve()
        self._balance()

    def _solve(self) -> None:
        """In whole numbers; Unlucky if a direction is not free."""
        solution = self.system.solved()
        self.X, self.d, self.Y = solution.X, solution.d, {**solution.Y}
        self.N = solution.N
        rows = [*self.convex.P, *(self.block.row(i).entries for i in self.W)]
        if any(along(row, v) for v in self.N for row in rows):
            raise Unlucky
        self.M = [{} for _ in self.N]
        if self.convex.P is not self.block.P:  # else P v = 0
            pairs = zip(self.N, solution.M, strict=True)
            self.M = [self._multipliers(v, m) for v, m in pairs]

    def _multipliers(self, v: Sequence[fmpz], m: dict[int, fmpq]) -> dict[int, fmpq]:
        """The m of P v = A_W'm, from those of the rows that are no bounds; Unlucky if none is."""
        pull = {j: fmpq(along(row, v)) for j, row in enumerate(self.block.P)}
        for i, factor in m.items():
            for j, entry in self.block.row(i).entries.items():
                pull[j] -= factor * entry
        of_bounds = {
            i: pull.pop(j) * self.block.row(i).entries[j] for j, (i, _) in self.system.fixed.items()
        }
        if any(pull.values()):
            raise Unlucky
        return {i: factor for i, factor in (m | of_bounds).items() if factor}

    def _solve_in_balls(self) -> None:
        """By multipliers: A P^-1 A' y = -c - A P^-1 (-q), of the coordinates that are left."""
        rest, general = self.system.rest, self.system.general
        held = {j: arb(v) for j, (_, v) in self.system.fixed.items()}
        r, g = len(rest), len(general)
        of_P, of_A = self.system.matrices()
        right = self.system.right_sides(held, arb(1))
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
        at: dict[int, Any] = dict(zip(rest, (x + moved * y).entries(), strict=True))
        self.X = [at[j] if j in at else held[j] for j in range(self.block.n)]
        self.d = arb(1)
        self.Y = dict(zip(general, y.entries(), strict=True))
        self.N, self.M = [], []

    def _balance(self) -> None:
        """Multipliers of bounds, from what the other rows leave of the cost."""
        fixed = self.system.fixed
        pull = {j: self.cost_slope(j) for j in (*fixed, *self.free)}
        for i in self.system.general:
            for j, v in self.block.row(i).entries.items():
                if j in pull:
                    pull[j] -= v * self.Y[i]
        self.balanced = not any(pull[j] for j in self.free)
        self.Y |= {i: pull[j] * self.block.row(i).entries[j] for j, (i, _) in fixed.items()}

    def at(self, w: Sequence[fmpz], factor: fmpz) -> Face:
        """The face at its point x + N w / (d factor), with the multipliers of that point."""
        X = [v * factor for v in self.X]
        Y = {i: v * factor for i, v in self.Y.items()}
        for k, n, m in zip(w, self.N, self.M, strict=True):
            X = [u + k * v for u, v in zip(X, n, strict=True)]
            for i, v in m.items():
                Y[i] += k * v
        return self._with(X=X, d=self.d * factor, Y=Y)

    def without(self, rows: Sequence[int]) -> Face:
        """The face without some rows that have no multiplier; its point is the same."""
        if not rows:
            return self
        Y = {i: v for i, v in self.Y.items() if i not in {*rows}}
        return self._with(X=self.X, d=self.d, Y=Y, W=[i for i in self.W if i in Y])

    def _with(self, **changes: Any) -> Face:
        other = object.__new__(Face)
        names = ("block", "convex", "W", "N", "M", "balanced")
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
            a, x = block.entries, self.x
            size = replace(a, value=np.abs(a.value) + UNDERFLOW).sums(np.abs(x) + UNDERFLOW)
            bound = (2 * block.n + 64) * UNIT * (size + np.abs(block.c)) + UNDERFLOW
            shown = a.sums(x) + block.c > bound
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
    def objective(self) -> Any:
        """The cost 1/2 x'Px + q'x, a fraction or a ball: half of q'x - c_W'y."""
        twice: Any = sum((v * w for v, w in zip(self.block.q, self.X, strict=True)), 0 * self.d)
        for i in self.W:
            side = self.block.row(i).side
            twice -= self.Y[i] * (arb(side) if isinstance(self.d, arb) else side)
        share = 1 / (2 * self.block.unit)
        if isinstance(self.d, arb):
            return twice * arb(share)
        return fmpq(twice) / self.d * share


def decided(block: Block, convex: Convex, decide: Callable[[bool], Result]) -> Result:
    """The answer of `decide` by balls where P is large and full, else modulo primes."""
    full = block.n > MANY_UNKNOWNS and 2 * sum(map(len, block.P)) > block.n**2
    if convex.definite and full:
        with suppress(Undecided), working_precision(BITS):
            return block.lucky(lambda: decide(True))
    return block.lucky(lambda: decide(False))
