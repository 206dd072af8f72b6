"""The rows that bear at the optimum of a block: by a guess that is proved, or by the dual method.

Where P is positive definite, the dual active-set method ends with them. Elsewhere the rows of a
guess are proved to bear on a face of optima, whose point of least norm is the answer. If no guess
holds, exact programs that are strictly convex decide: which rows bear if eps |x - x'|^2 / 2 is
added to the cost, for small eps those of an optimum; and where some eps show none, whether there is
a feasible point, and whether the cost falls without end along a direction.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count, islice
from typing import Any, Final

import numpy as np
from flint import arb, arb_mat, fmpq, fmpz

from quasistatic_ref.exact.active_set import Combination, dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, MatrixProgram, exact_matrix
from quasistatic_ref.exact.qp.block import Block, Convex, Unlucky, dense, matrix_form
from quasistatic_ref.exact.qp.face import Face, decided, sign
from quasistatic_ref.exact.qp.guess import Scaled, guesses
from quasistatic_ref.exact.qp.least_norm import LeastNorm
from quasistatic_ref.exact.qp.ray import ray_proof
from quasistatic_ref.exact.qp.short_proofs import short_proof
from quasistatic_ref.exact.qp.uniqueness import (
    combination,
    multipliers_witness,
    optimum_witness,
)
from quasistatic_ref.exact.time_limit import check_time
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.modulo import independent_modulo
from quasistatic_ref.numbers.precision import working_precision

Guesses = Iterable[tuple[Sequence[int], Array]]
ROUNDS: Final = 3
"""Values of eps after which it is asked whether there is an optimum."""


class Contradiction(Exception):
    """Rows of a block that contradict each other, a x + c each times its factor."""

    def __init__(self, factors: dict[int, fmpq]) -> None:
        super().__init__()
        self.factors = factors


class Endless(Exception):
    """A feasible `x`, and a `direction` along which the cost falls without end, in fractions."""

    def __init__(self, x: Sequence[fmpq], direction: Sequence[fmpq]) -> None:
        super().__init__()
        self.x, self.direction = x, direction


@dataclass(frozen=True, eq=False)
class BlockOptimum:
    """The optimum of a block, each number rounded correctly.

    Parameters
    ----------
    working : sequence of int
        Independent rows of the block that bear, and its equations.
    least : sequence of int
        Further rows that hold the optimum of least norm where it is.
    x, y : ndarray, shapes (n,) and (k,)
        Of the block's coordinates, and the multipliers of `working` [any unit].
    objective : fmpq or arb
        Of the block alone [any unit].
    unique : bool
        Whether the multipliers are the only ones.
    direction : list of fmpz or None
        A direction to another optimum; None if there is none.
    """

    working: Sequence[int]
    least: Sequence[int]
    x: Array
    y: Array
    objective: Any
    unique: bool
    direction: list[fmpz] | None


def optimum_at(face: Face, least: Sequence[int] = ()) -> BlockOptimum:
    """The optimum of a block, read from a face whose point is proved to be it."""
    tight = face.tight
    other = optimum_witness(face.block, face.N, tight)
    return BlockOptimum(
        face.W,
        least,
        x=face.x,
        y=face.y,
        objective=face.objective,
        unique=_multipliers_unique(face.block, face.W, tight),
        direction=None if other.unique else other.direction,
    )


def _multipliers_unique(block: Block, W: Sequence[int], tight: Sequence[int]) -> bool:
    """Whether multipliers of W are the only ones: not if an equation is left out of it."""
    if any(i < block.equations for i in tight):
        return False
    return multipliers_witness(block, W, tight).unique


def objective_of(block: Block, convex: Convex, optimum: BlockOptimum) -> fmpq:
    """The exact cost of an optimum of a block [any unit].

    Of a face in balls it is that of the same face in whole numbers.
    """
    objective = optimum.objective
    if isinstance(objective, arb):
        objective = block.lucky(lambda: Face(block, convex, optimum.working)).objective
    assert isinstance(objective, fmpq)
    return objective


def optimum(block: Block, convex: Convex, of_guesses: Guesses) -> BlockOptimum:
    """The optimum of a block; the one of least norm where there are others.

    Parameters
    ----------
    block : Block
    convex : Convex
        Its cost where something can move.
    of_guesses : iterable of (sequence of int, ndarray)
        Rows that seem to bear, in order of preference, and x [any unit].

    Raises
    ------
    Contradiction, Endless
        If there is none.
    """
    rows: Sequence[int] = ()
    centre: Array = np.zeros(block.n)
    for k, (some, x) in enumerate(of_guesses):
        if not k:
            rows, centre = some, np.where(np.isfinite(x), x, 0.0)
        found = optimum_on(block, convex, some)
        if found is not None:
            return found
        if convex.definite:
            break
    for proof in (short_proof, ray_proof):
        if (factors := proof(block)) is not None:
            raise Contradiction(factors)
    if not convex.definite:
        return _searched(block, convex, rows, centre)
    end = dual_active_set(block.form, rows)
    if isinstance(end, Combination):
        raise _contradiction(block, end.y)
    found = optimum_on(block, convex, end.working)
    assert found is not None  # the dual method ends at the optimum
    return found


def optimum_on(block: Block, convex: Convex, rows: Sequence[int]) -> BlockOptimum | None:
    """The optimum, if no other rows bear at it than equations and some of `rows`; else None."""
    return decided(block, convex, lambda balls: _optimum_on(block, convex, rows, balls=balls))


def _optimum_on(
    block: Block, convex: Convex, rows: Sequence[int], *, balls: bool
) -> BlockOptimum | None:
    e = block.equations
    W = block.independent([*dict.fromkeys((*range(e), *rows))])
    while True:
        check_time()
        face = Face(block, convex, W, balls=balls)
        if not face.balanced:
            return None
        signs = {i: sign(face.Y[i]) for i in W if i >= e}
        W = [i for i in W if i < e or signs[i] > 0]
        if convex.definite and min(signs.values(), default=1) >= 0:  # without what is zero, x stays
            face = face.without([i for i in face.W if i not in {*W}])
        if len(W) == len(face.W):
            break
    if not face.N:
        return None if face.violated else optimum_at(face)
    least = LeastNorm(face).optimum(strict)
    return None if least is None else optimum_at(*least)


def strict(form: MatrixProgram, warm: Sequence[int] | None = None) -> Minimiser | Combination:
    """The optimum of a strictly convex program of exact numbers, or a proof that there is none."""
    if warm is None:
        H, g = (np.array([[float(v) for v in row] for row in M.tolist()]) for M in (form.H, form.g))
        scaled = Scaled(H, -g[:, 0], *form.inequalities, form.equations)
        warm, _ = next(iter(guesses(scaled)), ((), None))
    return dual_active_set(form, warm)


def _searched(block: Block, convex: Convex, rows: Sequence[int], centre: Array) -> BlockOptimum:
    held = block.lucky(lambda: _held_equations(block))
    nearer = _nearer(block, convex, held, rows, centre)
    for found in islice(nearer, ROUNDS):
        if found is not None:
            return found
    x = _feasible(block, held, centre)
    direction = block.lucky(lambda: _endless(block, convex, held))
    if direction is not None:
        raise Endless(x, direction)
    for found in nearer:
        if found is not None:
            return found
    raise AssertionError  # it ends with an optimum


def feasible_point(block: Block) -> list[fmpq]:
    """The point of all rows that is nearest to zero; Contradiction if there is none."""
    held = block.lucky(lambda: _held_equations(block))
    return _feasible(block, held, np.zeros(block.n))


def _held_equations(block: Block) -> list[int]:
    """Independent equations; Contradiction if another one contradicts them."""
    held = block.independent(range(block.equations))
    for p in sorted({*range(block.equations)} - {*held}):
        c = combination(block, held, p)
        if c is None:
            raise Unlucky
        y = {i: -v * block.row(i).unit for i, v in c.items() if v} | {p: block.row(p).unit}
        _, total = block.combined(y)
        if total:
            raise Contradiction({i: -v if total > 0 else v for i, v in y.items()})
    return held


def _contradiction(block: Block, y: dict[int, fmpq]) -> Contradiction:
    return Contradiction({i: v * block.row_units.get(i, 1) for i, v in y.items()})


def _feasible(block: Block, held: Sequence[int], centre: Array) -> list[fmpq]:
    """The point of all rows that is nearest to a centre."""
    n = block.n
    some = [*held, *range(block.equations, block.m)]
    rows = [block.exact_rows[i] for i in some]
    form = matrix_form(exact_matrix(np.eye(n)), exact_matrix(centre[:, None]), rows, len(held))
    end = strict(form)
    if isinstance(end, Combination):
        raise _contradiction(block, {some[t]: v for t, v in end.y.items()})
    return end.fractions.exact_x


def _endless(block: Block, convex: Convex, held: Sequence[int]) -> list[fmpq] | None:
    """The projection of -q on directions that no row ends and P leaves free; None if it is zero."""
    n, e = block.n, block.equations
    lines = [dense(row, range(n)) for row in convex.P if row]
    lines += [dense(block.row(i).entries, range(n)) for i in held]
    first = [lines[t] for t in independent_modulo(lines, block.prime)]
    with working_precision(EXACT):
        most = [max(int(v).bit_length() for v in map(abs, line)) for line in first]
        rows = [
            [*(arb(v) * arb(2) ** -k for v in line), arb(0)]
            for line, k in zip(first, most, strict=True)
        ]
        rows += [[*row[:-1], arb(0)] for row in block.exact_rows[e:]]
        share = arb(2) ** -max((int(v).bit_length() for v in map(abs, convex.q)), default=0)
        g = arb_mat(n, 1, [-v * share for v in convex.q])
    end = strict(matrix_form(exact_matrix(np.eye(n)), g, rows, len(first)))
    assert isinstance(end, Minimiser)  # zero satisfies all rows
    direction = end.fractions.exact_x
    if not any(direction):
        return None
    column = {j: v for j, v in enumerate(direction) if v}
    zero = (
        sum((v * column[j] for j, v in enumerate(line) if j in column), fmpq(0)) for line in lines
    )
    if any(zero):
        raise Unlucky
    return direction


def _nearer(
    block: Block, convex: Convex, held: Sequence[int], rows: Sequence[int], centre: Array
) -> Iterator[BlockOptimum | None]:
    """What bearing rows prove, found with ever less of |x - x'|^2 added to the cost."""
    n, e = block.n, block.equations
    some = [*held, *range(e, block.m)]
    at = {i: t for t, i in enumerate(some)}
    exact = [block.exact_rows[i] for i in some]
    P, g = convex.balls
    most = max(
        (int(m).bit_length() + int(e) for m, e in map(arb.man_exp, P.entries()) if m), default=0
    )
    for k in count(4):
        with working_precision(EXACT):
            weight = exact_matrix(np.eye(n)) * arb(2) ** (most - 2**k)  # no float64 is so small
            form = matrix_form(
                P + weight, g + weight * exact_matrix(centre[:, None]), exact, len(held)
            )
        end = strict(form, [at[i] for i in rows if i in at])
        if isinstance(end, Combination):
            return  # no point is feasible
        x = end.balls.floats[0]
        rows, centre = [some[t] for t in end.working], np.where(np.isfinite(x), x, 0.0)
        yield optimum_on(block, convex, rows)
