"""Whether a proof that a program has no optimum holds, checked without a solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from flint import fmpq

from quasistatic_ref.exact.fractions import fractions_read
from quasistatic_ref.exact.qp.block import Block, along
from quasistatic_ref.exact.qp.program import QuadraticProgram
from quasistatic_ref.numbers.precision import check_arithmetic


def row_factors(names: Sequence[str], exact: Mapping[str, str]) -> dict[int, fmpq]:
    """Factors of rows a x + c by place, of those texts by name that are fractions of rows."""
    place = {name: i for i, name in enumerate(names)}
    read = {name: fractions_read([text]) for name, text in exact.items() if name in place}
    return {place[name]: -v[0] if name.startswith("A[") else v[0] for name, v in read.items() if v}


class Proof:
    """A program in fractions, to check a claim about all of it.

    Parameters
    ----------
    problem : QuadraticProgram
    """

    def __init__(self, problem: QuadraticProgram) -> None:
        check_arithmetic()
        self.names = problem.rows.names
        n, m = len(problem.q), len(self.names)
        self.block = Block(problem, np.arange(n), np.arange(m))

    def infeasible(self, factors: Mapping[str, str]) -> str:
        """What is wrong with a proof that there is no solution; empty if it holds."""
        if fractions_read([*factors.values()]) is None:
            return "the proof has factors that are no fractions"
        for name in factors:
            if name not in self.names:
                return f"the proof uses {name!r}, which is no limit of the program"
        by_row = row_factors(self.names, factors)
        for i, v in by_row.items():
            if v < 0 and i >= self.block.equations:
                return f"the factor of {self.names[i]} is negative"
        left, limit = self.block.combined(by_row)
        if left:
            return "the rows of the proof do not add up to zero"
        return "" if limit < 0 else "the limits that the proof adds up are not negative"

    def unbounded(self, x: Sequence[str], direction: Sequence[str]) -> str:
        """What is wrong with a feasible x and a direction that lowers the cost without end."""
        point, way = (self._vector(texts) for texts in (x, direction))
        if point is None or way is None:
            return f"x or the direction is no list of {self.block.n} fractions"
        block = self.block
        for i, name in enumerate(self.names):
            entries, side, _ = block.row(i)
            slack, slope = along(entries, point) + side, along(entries, way)
            is_equation = i < block.equations
            if slack < 0 or (is_equation and slack):
                return f"{name} is violated by x"
            if slope < 0 or (is_equation and slope):
                return f"{name} ends the direction"
        pull = [along(row, way) for row in block.P]
        if sum((u * v for u, v in zip(pull, way, strict=True)), fmpq(0)) > 0:
            return "the cost grows along the direction"
        slope = sum((u * v for u, v in zip(pull, point, strict=True)), fmpq(0))
        slope += sum((u * v for u, v in zip(block.q, way, strict=True)), fmpq(0))
        return "" if slope < 0 else "the cost does not fall along the direction"

    def not_convex(self, direction: Sequence[str]) -> str:
        """What is wrong with a direction that equations leave and that costs less than nothing."""
        way = self._vector(direction)
        if way is None:
            return f"the direction is no list of {self.block.n} fractions"
        for i in range(self.block.equations):
            if along(self.block.row(i).entries, way):
                return f"{self.names[i]} does not leave the direction"
        terms = (v * along(row, way) for v, row in zip(way, self.block.P, strict=True))
        return "" if sum(terms, fmpq(0)) < 0 else "the direction does not cost less than nothing"

    def _vector(self, texts: Sequence[str]) -> list[fmpq] | None:
        read = fractions_read(texts)
        return read if read is not None and len(read) == self.block.n else None
