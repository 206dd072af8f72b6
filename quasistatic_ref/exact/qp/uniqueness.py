"""Whether multipliers, and the optimum, are the only ones: each time with a witness."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.exact.active_set import dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import exact_matrix
from quasistatic_ref.exact.qp.block import (
    Block,
    Unlucky,
    along,
    dense,
    matrix_form,
    shortest,
)
from quasistatic_ref.numbers.modulo import independent_modulo


def combination(block: Block, W: Sequence[int], p: int) -> dict[int, fmpq] | None:
    """The c of a_p = sum_i c_i a_i over independent rows W; None if a_p does not depend on them.

    Rows are those of :meth:`Block.row`. An unlucky prime raises Unlucky.
    """
    bounds, general, rest = block.split(W)
    rows = [dense(block.row(i).entries, rest) for i in general]
    a = block.row(p).entries
    some = independent_modulo([*map(list, zip(*rows, strict=True))], block.prime)
    if len(some) < len(general):
        raise Unlucky
    c: dict[int, fmpq] = {}
    if general:
        square = fmpz_mat([[row[t] for row in rows] for t in some])
        right = fmpz_mat(len(some), 1, [a.get(rest[t], fmpz(0)) for t in some])
        c = dict(zip(general, cast("fmpq_mat", square.solve(right)).entries(), strict=True))
    left = {j: fmpq(v) for j, v in a.items()}
    for i, v in c.items():
        for j, entry in block.row(i).entries.items():
            left[j] = left.get(j, fmpq(0)) - v * entry
    for j, i in bounds.items():
        c[i] = left.pop(j, fmpq(0)) * block.row(i).entries[j]
    return None if any(left.values()) else c


class Witness(NamedTuple):
    """Why multipliers, or an optimum, are the only ones, or not.

    Parameters
    ----------
    unique : bool
    factors : dict of int to fmpq
        Of rows. If multipliers are not unique, those of a sum that is zero, positive but of
        equations and bearing rows; if an optimum is, positive ones of tight rows that end all
        directions.
    direction : list of fmpz
        If multipliers are unique, one that tight rows increase along, where no row depends on
        others none; if an optimum is not, one to another.
    """

    unique: bool
    factors: dict[int, fmpq]
    direction: list[fmpz]


def multipliers_witness(block: Block, W: Sequence[int], tight: Sequence[int]) -> Witness:
    """Whether the multipliers are the only ones, `tight` being the other rows without slack.

    They are iff A_W'c = A_E'c_E with c_E >= 0, and any sign for equations, implies c_E = 0; by
    Gordan's theorem, iff some v has A_W v = 0 and A_E v > 0.
    """
    if not tight or block.surely_independent([*W, *tight]):
        return Witness(True, {}, [])
    for p in sorted(tight, key=lambda p: p >= block.equations):  # all equations depend on W
        c = combination(block, W, p)
        if c is not None:
            return Witness(False, {i: -v for i, v in c.items() if v} | {p: fmpq(1)}, [])
    bounds, general, rest = block.split(W)
    sides = [arb(0)] * len(general) + [arb(-1)] * len(tight)
    rows = [
        [*map(arb, dense(block.row(i).entries, rest)), side]
        for i, side in zip([*general, *tight], sides, strict=True)
    ]
    n = len(rest)
    form = matrix_form(exact_matrix(np.eye(n)), arb_mat(n, 1), rows, len(general))
    end = dual_active_set(form)
    if isinstance(end, Minimiser):
        entries = dict(zip(rest, end.fractions.exact_x, strict=True))
        return Witness(True, {}, _whole([entries.get(j, fmpq(0)) for j in range(block.n)]))
    some = [*general, *tight]
    factors = {some[t]: v for t, v in end.y.items()}
    left: dict[int, fmpq] = {}
    for i, v in factors.items():
        for j, entry in block.row(i).entries.items():
            left[j] = left.get(j, fmpq(0)) + v * entry
    of_bounds = {i: -left.get(j, fmpq(0)) * block.row(i).entries[j] for j, i in bounds.items()}
    return Witness(False, factors | {i: v for i, v in of_bounds.items() if v}, [])


def optimum_witness(block: Block, N: Sequence[list[fmpz]], tight: Sequence[int]) -> Witness:
    """Whether there is another optimum along some directions N, which P and W leave free.

    A direction leads from no other row without slack to its wrong side. There is none iff positive
    factors t of these rows have t'A N = 0, and A N has the rank of N (Stiemke).
    """
    size = len(N)
    if not size:
        return Witness(True, {}, [])
    signed = [i for i in tight if i >= block.equations]
    along_N = {i: [along(block.row(i).entries, n) for n in N] for i in signed}
    rows = {i: row for i, row in along_N.items() if any(row)}
    lines = [*rows.values()]
    basis, free = (fmpz_mat(lines) if lines else fmpz_mat(1, size)).nullspace()
    if free:
        w = [fmpq(basis[k, 0]) for k in range(size)]
    else:  # some row increases
        total = [sum(column, fmpz(0)) for column in zip(*lines, strict=True)]
        least = [0] * len(lines) + [1]
        exact = [[*map(arb, row), arb(-b)] for row, b in zip([*lines, total], least, strict=True)]
        form = matrix_form(exact_matrix(np.eye(size)), arb_mat(size, 1), exact, 0)
        end = dual_active_set(form)
        if not isinstance(end, Minimiser):
            last = end.y[len(lines)]
            factors = {i: end.y.get(t, fmpq(0)) + last for t, i in enumerate(rows)}
            return Witness(True, factors, [])
        w = end.fractions.exact_x
    way = fmpq_mat(fmpz_mat([*N]).transpose()) * fmpq_mat(size, 1, w)
    return Witness(False, {}, shortest(way.numer_denom()[0].entries()))


def _whole(v: Sequence[fmpq]) -> list[fmpz]:
    """Fractions times the least number that makes them whole."""
    return fmpq_mat(len(v), 1, [*v]).numer_denom()[0].entries()
