"""Correct digits of an x, and of multipliers, measured against the exact optimum."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from flint import arb, arb_mat
from numpy.typing import ArrayLike

from quasistatic_ref.certify.form import EXACT, PRECISION, exact_matrix
from quasistatic_ref.certify.norm import digits_of_error
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.qp.block import Block, Convex, blocks_of, dense
from quasistatic_ref.optional.qp.convexity import convex_cost
from quasistatic_ref.optional.qp.program import QuadraticProgram


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
        lost = arb(0)
        for block, convex in costs:
            part = arb_mat([[change[int(j), 0]] for j in block.coordinates])
            P = arb_mat([dense(row, range(block.n)) for row in convex.P]) * (1 / arb(convex.unit))
            lost += _square(part, P * part)
        of_q = abs((exact_matrix(problem.q[None]) * change)[0, 0])
        slack = (
            (exact_matrix(rows.a) * _column(off) + _column(rows.c)).entries() if rows.names else []
        )
    most = np.abs(optimum).max(initial=0.0)
    terms = np.abs(optimum) @ np.abs(problem.P) @ np.abs(optimum) + np.abs(problem.q) @ np.abs(
        optimum
    )
    short = np.array([float(s) for s in slack])
    short[: rows.equations] = -np.abs(short[: rows.equations])
    sizes = np.abs(rows.a).max(axis=1, initial=0.0) * most + np.abs(rows.c)
    errors = [
        math.sqrt(max(_ratio(float(lost), terms), 0.0)),
        _ratio(float(of_q), terms),
        *map(_ratio, np.maximum(-short, 0).tolist(), sizes.tolist()),
    ]
    return digits_of_error(float(np.max(errors)))  # NaN of one is NaN of all


def multiplier_digits(
    problem: QuadraticProgram, optimum: Array, given: Mapping[str, ArrayLike | None]
) -> float:
    """Correct digits of multipliers, as of ``ExactQP.digits_of_multipliers`` [-].

    `optimum`, shape (n,) or of rows is the exact answer.
    """
    sizes = problem.sizes
    z, y, z_box = (
        _numbers(np.zeros(size) if empty(given[name]) else given[name], name, size)
        for name, size in sizes.items()
    )
    n = len(problem.q)
    eye = np.eye(n)
    matrix = exact_matrix(np.concatenate([problem.G, problem.A, eye, eye]).T)
    every = np.concatenate([z, y, z_box, problem.q])
    with working_precision(EXACT):
        force = (matrix * _column(every)).entries()

    def moved(block: Block) -> arb_mat:
        pull = arb_mat([[force[int(i)]] for i in block.coordinates])
        return block.form.H_inverse * pull + _column(optimum, block)

    costs = _costs(problem)
    if all(convex.definite for _, convex in costs):
        return _definite_digits(costs, optimum, moved)
    with working_precision(PRECISION):
        half = exact_matrix(problem.P) + exact_matrix(problem.P.T)
        pull = (half * _column(optimum) * arb(0.5)).entries()
        left = max(abs(float(u + v)) for u, v in zip(pull, force, strict=True))
    terms = np.abs(problem.P) @ np.abs(optimum) + np.abs(
        np.concatenate([problem.G, problem.A, eye, eye])
    ).T @ np.abs(every)
    allowed = (
        np.where(np.isfinite(problem.ub), np.inf, 0.0),
        np.where(np.isfinite(problem.lb), -np.inf, 0.0),
    )
    wrong = np.append(np.maximum(-z, 0), np.abs(z_box - np.clip(z_box, allowed[1], allowed[0])))
    limit = np.where(z_box > 0, problem.ub, problem.lb)
    with np.errstate(invalid="ignore"):
        gaps = np.append(
            np.where(z != 0, z * (problem.G @ optimum - problem.h), 0.0),
            np.where(np.isfinite(limit), z_box * (optimum - limit), 0.0),
        )
    worth = np.abs(optimum) @ terms
    errors = [
        _ratio(left, terms.max()),
        _ratio(float((wrong @ np.abs(np.concatenate([problem.G, eye]))).max()), terms.max()),
        _ratio(float(np.abs(gaps).max(initial=0.0)), worth),
    ]
    return digits_of_error(float(np.max(errors)))  # NaN of one is NaN of all


def empty(value: Any) -> bool:
    """Whether an answer leaves multipliers out, which are zero then."""
    return value is None or np.size(value) == 0


def _costs(problem: QuadraticProgram) -> list[tuple[Block, Convex]]:
    return [(block, convex_cost(block)) for block in blocks_of(problem)]


def _ratio(off: float, size: float) -> float:
    return 0.0 if off == 0 else off / size if size else math.inf


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
