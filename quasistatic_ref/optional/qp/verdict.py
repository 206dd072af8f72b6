"""Whether what is said of a program is proved, checked without a solver and without a search."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.farkas import fractions_read
from quasistatic_ref.certify.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.optional.qp.block import Block, Convex, blocks_of
from quasistatic_ref.optional.qp.convexity import Indefinite, convex_cost
from quasistatic_ref.optional.qp.face import Face, along, decided, sign
from quasistatic_ref.optional.qp.least_norm import LeastNorm
from quasistatic_ref.optional.qp.program import QuadraticProgram
from quasistatic_ref.optional.qp.search import BlockOptimum, optimum_at


def answer_fields(
    problem: QuadraticProgram, blocks: Sequence[Block], optima: Sequence[BlockOptimum]
) -> dict[str, Any]:
    """The fields of an answer, but its problem, from the optima of its blocks."""
    names = problem.rows.names
    n = len(problem.q)
    x, of_rows = np.zeros(n), np.zeros(len(names))
    active: list[int] = []
    least: list[int] = []
    direction: list[str] = []
    for block, optimum in zip(blocks, optima, strict=True):
        held = block.rows[[*optimum.working]]
        x[block.coordinates] = optimum.x
        of_rows[held] = optimum.y
        active += held.tolist()
        least += block.rows[[*optimum.least]].tolist()
        if optimum.direction is not None and not direction:
            direction = [*map(str, block.spread(optimum.direction, 0))]
    terms = np.concatenate([*(optimum.objective for optimum in optima), _terms(problem)])
    obj = math.fsum(terms)
    return {
        "x": x,
        **problem.multipliers(of_rows),
        "obj": obj,
        "obj_error": math.fsum(np.spacing(np.abs([obj, *terms]))),
        "active": tuple(names[i] for i in sorted(active)),
        "multipliers_unique": all(optimum.unique for optimum in optima),
        "least_norm": tuple(names[i] for i in sorted(least)),
        "direction": tuple(direction),
    }


def _terms(problem: QuadraticProgram) -> Array:
    """The constant of the objective, if there is one."""
    return np.array([problem.constant] if problem.constant else [])


def optimum_verdict(problem: QuadraticProgram, claims: Mapping[str, Any]) -> Verdict:
    """Whether each number of an optimum is right."""
    check_arithmetic()
    names = problem.rows.names
    for field in ("active", "least_norm"):
        unknown = [name for name in claims[field] if name not in names]
        if unknown:
            return Verdict(False, f"{field} names {unknown[0]!r}, which is no row of the program")
    blocks = blocks_of(problem)
    optima = []
    for block in blocks:
        found = _of_block(block, [names[i] for i in block.rows], claims)
        if isinstance(found, str):
            return Verdict(False, found)
        optima.append(found)
    for name, right in answer_fields(problem, blocks, optima).items():
        fault = wrong_bits if isinstance(right, np.ndarray) else wrong_claim
        if reason := fault(name, claims[name], right):
            return Verdict(False, reason)
    return Verdict(True)


def _of_block(block: Block, names: Sequence[str], claims: Mapping[str, Any]) -> BlockOptimum | str:
    """The optimum of a block on its claimed rows, or what is wrong with what is claimed."""
    try:
        convex = convex_cost(block)
    except Indefinite:
        return "P is not convex where something can move"
    W, least = (
        [i for i, name in enumerate(names) if name in claims[field]]
        for field in ("active", "least_norm")
    )
    return decided(
        block, convex, lambda balls: _on_claimed_rows(block, convex, W, least, names, balls)
    )


def _on_claimed_rows(
    block: Block,
    convex: Convex,
    W: Sequence[int],
    least: Sequence[int],
    names: Sequence[str],
    balls: bool,
) -> BlockOptimum | str:
    """The optimum of a block on its claimed rows, or what is wrong with them."""
    e = block.equations
    if not block.are_independent(W):
        return "the active rows are not independent"
    left = [i for i in range(e) if i not in {*W}]
    if len(block.independent([*W, *left])) > len(W):
        return "active leaves out an equation that does not follow from it"
    face = Face(block, convex, W, balls=balls)
    if not face.balanced:
        return "the active rows leave a direction that lowers the cost"
    for i in W:
        s = sign(face.Y[i])
        if i >= e and s <= 0:
            return f"the multiplier of {names[i]} is {'negative' if s else 'zero'}"
    reason = "the rows of least norm are not needed" if least else ""
    if face.N:
        face, reason = LeastNorm(face).on_rows(least)
    if reason:
        return reason
    if face.violated:
        return f"{names[face.violated[0]]} is violated by the minimiser on the active rows"
    return optimum_at(face, least)


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
