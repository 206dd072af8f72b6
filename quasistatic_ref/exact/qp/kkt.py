r"""The linear system of some rows W that hold, solved.

It is :math:`P x + q = A_W^T y` and :math:`A_W x + c_W = 0`. Bounds of W are substituted. Directions
that P and W leave free have one free coordinate each, which is zero in the solution. What is solved
here is believed by nobody: who uses it puts it into the equations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import fmpq, fmpz

from quasistatic_ref.exact.qp.block import Block, Sparse, Unlucky, dense, shortest
from quasistatic_ref.exact.qp.sparse import solution


@dataclass(frozen=True, eq=False)
class Solution:
    """A solution of the system, and of the same system without q and c.

    Parameters
    ----------
    X, d : list of fmpz, fmpz
        x times d, and d.
    Y : dict of int to fmpz
        Of each row of W that is no bound its multiplier times d.
    N : list of list of fmpz
        Directions, n whole numbers without a common factor each.
    M : list of dict of int to fmpq
        Of each the multipliers of the rows that are no bounds.
    """

    X: list[fmpz]
    d: fmpz
    Y: dict[int, fmpz]
    N: list[list[fmpz]]
    M: list[dict[int, fmpq]]


class System:
    """The system of some independent rows of a block.

    Parameters
    ----------
    block : Block
    W : sequence of int
    free : sequence of int
        The free coordinates.

    Attributes
    ----------
    general : list of int
        The rows of W that are no bounds.
    fixed : dict of int to (int, fmpq)
        By coordinate the bound of W on it, and where that holds it.
    rest : list of int
        The coordinates that are neither fixed nor free.
    """

    def __init__(self, block: Block, W: Sequence[int], free: Sequence[int]) -> None:
        self.block, self.free = block, free
        bounds, self.general, _ = block.split(W)
        self.fixed = {
            j: (i, -block.row(i).side * block.row(i).entries[j]) for j, i in bounds.items()
        }
        taken = {*free, *self.fixed}
        self.rest = [j for j in range(block.n) if j not in taken]

    def matrices(self) -> tuple[list[list[fmpz]], list[list[fmpz]]]:
        """P on the coordinates that are left, and the other rows of W on them."""
        of_P, of_A = ([dense(line, self.rest) for line in some] for some in self.lines())
        return of_P, of_A

    def lines(self) -> tuple[list[Sparse], list[Sparse]]:
        """Rows of P at the coordinates that are left, and the other rows of W."""
        general = [self.block.row(i).entries for i in self.general]
        return [self.block.P[j] for j in self.rest], general

    def right_sides(self, held: dict[int, Any], common: Any) -> list[Any]:
        """What substituted coordinates and constants leave to the rest, times `common`."""
        block = self.block

        def moved(entries: Sparse) -> Any:
            return sum((v * held[k] for k, v in entries.items() if k in held), 0 * common)

        of_x = [-block.q[j] * common - moved(block.P[j]) for j in self.rest]
        rows = map(block.row, self.general)
        return of_x + [-row.side.p * common - moved(row.entries) for row in rows]

    def solved(self) -> Solution:
        """The solution, and a direction for each free coordinate; Unlucky if it has no one."""
        block, r, g = self.block, len(self.rest), len(self.general)
        common = fmpz(1)
        for _, v in self.fixed.values():
            common = common.lcm(v.q)
        held = {j: (v * common).p for j, (_, v) in self.fixed.items()}
        of_P, of_A = self.lines()
        sides = [self.right_sides(held, common)]
        sides += [[-line.get(j, fmpz(0)) for line in (*of_P, *of_A)] for j in self.free]
        columns: list[list[fmpz]] = [[] for _ in sides]
        denominator = fmpz(1)
        if r + g:
            try:
                columns, denominator = self._columns(sides)
            except ZeroDivisionError:
                raise Unlucky from None
        at: dict[int, Any] = dict(zip(self.rest, columns[0], strict=False))
        N, M = [], []
        for j, column in zip(self.free, columns[1:], strict=True):
            entries = dict(zip(self.rest, column, strict=False)) | {j: denominator}
            N.append(shortest([entries.get(k, fmpz(0)) for k in range(block.n)]))
            share = fmpq(N[-1][j], denominator)
            M.append({i: v * share for i, v in zip(self.general, column[r:], strict=True)})
        return Solution(
            X=[at[j] if j in at else held.get(j, fmpz(0)) * denominator for j in range(block.n)],
            d=denominator * common,
            Y=dict(zip(self.general, columns[0][r:], strict=True)),
            N=N,
            M=M,
        )

    def _columns(self, sides: list[list[fmpz]]) -> tuple[list[list[fmpz]], fmpz]:
        """The solution for each right side, times a common denominator, and that."""
        r, g = len(self.rest), len(self.general)
        place = {j: t for t, j in enumerate(self.rest)}
        of_P, of_A = (
            [{place[j]: v for j, v in line.items() if j in place} for line in some]
            for some in self.lines()
        )
        across: list[Sparse] = [{} for _ in self.rest]
        for t, line in enumerate(of_A):
            for k, v in line.items():
                across[k][r + t] = -v
        if r == g and not any(of_P):  # as of a linear program: x and y by themselves
            X, u = solution(of_A, range(r), [side[r:] for side in sides])
            Y, v = solution(across, range(r, r + g), [side[:r] for side in sides])
            d = u.lcm(v)
            return [
                [*(a * (d / u) for a in x), *(b * (d / v) for b in y)]
                for x, y in zip(X, Y, strict=True)
            ], d
        upper = [p | a for p, a in zip(of_P, across, strict=True)]
        return solution([*upper, *of_A], range(r + g), sides)
