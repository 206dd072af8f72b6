"""Correct digits of an x, and of multipliers, measured against the exact optimum."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from flint import arb, arb_mat, fmpq
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.digits import digits_of_error
from quasistatic_ref.exact.program import EXACT, PRECISION, exact_matrix
from quasistatic_ref.exact.qp.block import Block, Convex, blocks_of, dense
from quasistatic_ref.exact.qp.convexity import convex_cost
from quasistatic_ref.exact.qp.program import QuadraticProgram
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.numbers.precision import working_precision


def correct_digits(problem: QuadraticProgram, optimum: Array, x: ArrayLike) -> float:
    """Correct digits of an x, (n,), as of :meth:`~quasistatic_ref.ExactQP.digits` [-].

    `optimum` is the exact answer.
    """
    off = _numbers(x, "x", len(optimum))
    costs = _costs(problem)
    if all(convex.definite for _, convex in costs):
        return _definite_digits(
            costs, optimum, lambda block: _column(off, block) - _column(optimum, block)
        )
    rows = problem.rows
    with working_precision(PRECISION):
        change = _column(off) - _column(optimum)
        lost = fall = arb(0)
        for block, convex in costs:
            part = arb_mat([[change[int(j), 0]] for j in block.coordinates])
            P = arb_mat([dense(row, range(block.n)) for row in convex.P]) * (1 / arb(convex.unit))
            lost += _square(part, P * part)
            fall += _square(arb_mat(block.n, 1, convex.q) * (1 / arb(convex.unit)), part)
        terms, units = _natural(problem, optimum)
        errors = [math.sqrt(max(_share(lost, terms), 0.0)), _share(fall, terms)]
        if rows.names:
            slack = (exact_matrix(rows.a) * _column(off) + _column(rows.c)).entries()
            short = [v if i < rows.equations or v < 0 else arb(0) for i, v in enumerate(slack)]
            lengths = exact_matrix(np.abs(rows.a))
            sizes = lengths * _column(np.abs(optimum)) + _column(np.abs(rows.c))
            natural = (lengths * units).entries()
            errors += map(_share, short, map(_or, sizes.entries(), natural))
    return digits_of_error(float(np.max(errors)))  # NaN of one is NaN of all


def _natural(problem: QuadraticProgram, optimum: Array) -> tuple[arb, arb_mat]:
    """The size of the terms of the cost at the optimum, and a natural unit of each coordinate.

    The unit of a coordinate changes the cost by the size of its terms. Where the coordinate costs
    nothing it is the longest coordinate; where all are zero, or cost nothing, it is one.
    """
    P, q, size = (
        exact_matrix(np.abs(v)) for v in (problem.P, problem.q[:, None], optimum[:, None])
    )
    slopes = P * size + q
    terms = _square(size, slopes)
    longest = arb(np.abs(optimum).max(initial=0.0) or 1.0)
    of_slopes = [terms / v if terms > 0 and v > 0 else longest for v in slopes.entries()]
    units = arb_mat(len(of_slopes), 1, of_slopes)
    return _or(_or(terms, _square(units, P * units + q)), arb(1)), units


def multiplier_digits(
    problem: QuadraticProgram,
    optimum: Mapping[str, Any],
    exact: Sequence[fmpq],
    given: Mapping[str, ArrayLike | None],
) -> float:
    """Correct digits of multipliers, as of ``ExactQP.digits_of_multipliers`` [-].

    `optimum` has the exact answer rounded, x and multipliers by name, and `exact` is that x in
    fractions.
    """
    z, y, z_box = (
        _numbers(np.zeros(size) if empty(given[name]) else given[name], name, size)
        for name, size in problem.sizes.items()
    )
    n = len(problem.q)
    rows = np.concatenate([problem.G, problem.A, np.eye(n), np.eye(n)]).T
    every = np.concatenate([z, y, z_box, problem.q])
    with working_precision(EXACT):
        force = (exact_matrix(rows) * _column(every)).entries()

    def moved(block: Block) -> arb_mat:
        pull = arb_mat([[force[int(i)]] for i in block.coordinates])
        of_block = [arb(exact[int(i)]) for i in block.coordinates]
        return block.form.H_inverse * pull + arb_mat(block.n, 1, of_block)

    costs = _costs(problem)
    if all(convex.definite for _, convex in costs):
        return _definite_digits(costs, optimum["x"], moved)
    with working_precision(PRECISION):
        x = arb_mat(n, 1, [*map(arb, exact)])
        half = exact_matrix(problem.P) + exact_matrix(problem.P.T)
        left = half * x * arb(0.5) + arb_mat(n, 1, force)
        terms, units = _natural(problem, optimum["x"])
        size = _column(np.abs(optimum["x"]))
        of_P = exact_matrix(np.abs(problem.P)) * size
        lengths = exact_matrix(np.abs(rows))
        right = np.concatenate([*(optimum[name] for name in problem.sizes), problem.q])
        of_given, of_right = (of_P + lengths * _column(np.abs(v)) for v in (every, right))
        natural = (terms / unit for unit in units.entries())
        least = map(_or, of_right.entries(), natural)
        sizes = arb_mat(n, 1, [*map(max, of_given.entries(), least)])
        worth = _or(_square(size, sizes), _square(units, sizes))
        wrong = np.concatenate([*_wrong(problem, z, y, z_box), 0 * problem.q])
        missed = lengths * _column(wrong)
        gaps = _gaps(problem, x, z, z_box)
        errors = [_share(gap, worth) for gap in gaps]
        for off in (left, missed):
            errors += map(_share, off.entries(), sizes.entries())
    return digits_of_error(float(np.max(errors)))  # NaN of one is NaN of all


def _wrong(problem: QuadraticProgram, z: Array, y: Array, z_box: Array) -> tuple[Array, ...]:
    """What of each multiplier has the wrong sign, or no limit."""
    none_above, none_below = np.isinf(problem.ub), np.isinf(problem.lb)
    of_z = np.where(np.isinf(problem.h), np.abs(z), np.maximum(-z, 0))
    return of_z, 0 * y, np.where(np.where(z_box > 0, none_above, none_below), np.abs(z_box), 0)


def _gaps(problem: QuadraticProgram, x: arb_mat, z: Array, z_box: Array) -> list[arb]:
    """Each multiplier of an inequality times the slack of its limit."""
    limits = np.where(z_box > 0, problem.ub, problem.lb)
    rows = np.isfinite(problem.h)
    bounds = np.isfinite(limits)
    slack = (exact_matrix(problem.G[rows]) * x - _column(problem.h[rows])).entries()
    slack += [x[j, 0] - limits[j] for j in np.flatnonzero(bounds).tolist()]
    given = _column(np.append(z[rows], z_box[bounds])).entries()
    return [v * w for v, w in zip(given, slack, strict=True)]


def empty(value: Any) -> bool:
    """Whether an answer leaves multipliers out, which are zero then."""
    return value is None or np.size(value) == 0


def _costs(problem: QuadraticProgram) -> list[tuple[Block, Convex]]:
    return [(block, convex_cost(block)) for block in blocks_of(problem)]


def _or(size: arb, other: arb) -> arb:
    return other if size.is_zero() else size


def _share(off: arb, size: arb) -> float:
    """The size of a number over another one [-]."""
    if off.is_zero():
        return 0.0
    return math.inf if size.is_zero() else float(abs(off / size).mid())


def _definite_digits(
    costs: list[tuple[Block, Convex]], optimum: Array, error_of: Callable[[Block], arb_mat]
) -> float:
    """Correct digits from the errors of each block, in the norm of P."""
    with working_precision(PRECISION):
        off, length, free = arb(0), arb(0), arb(0)
        for block, _ in costs:
            form, error, x = block.form, error_of(block), _column(optimum, block)
            off += _square(error, form.H * error)
            length += _square(x, form.H * x)
            free += _square(form.g, form.H_inverse * form.g)
        longer = max(length.mid(), free.mid())
        if not longer > 0:
            return digits_of_error(0.0 if off == 0 else math.inf)
        share = float((off / longer).mid())
        return digits_of_error(math.sqrt(share) if share >= 0 else math.nan)


def _numbers(value: ArrayLike | None, name: str, size: int) -> Array:
    numbers = checked_numbers(value, name, InputError).reshape(-1)
    if numbers.shape != (size,):
        raise InputError(f"must be {size} numbers", field=name, value=numbers.shape)
    return numbers


def _column(numbers: Array, block: Block | None = None) -> arb_mat:
    return exact_matrix((numbers if block is None else numbers[block.coordinates])[:, None])


def _square(u: arb_mat, v: arb_mat) -> arb:
    return (u.transpose() * v)[0, 0]
