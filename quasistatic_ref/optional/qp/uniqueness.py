"""Whether multipliers, and the optimum, are the only ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.active_set import dual_active_set
from quasistatic_ref.certify.form import exact_matrix
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.numbers.modulo import independent_modulo
from quasistatic_ref.optional.qp.block import Block, Unlucky, dense, matrix_form, shortest
from quasistatic_ref.optional.qp.face import Face, along


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


def multipliers_unique(face: Face, tight: Sequence[int]) -> bool:
    """Whether the multipliers are the only ones, `tight` being the other rows without slack.

    They are iff A_W'c = A_E'c_E with c_E >= 0, and any sign for equations, implies c_E = 0; by
    Gordan's theorem, iff some v has A_W v = 0 and A_E v > 0.
    """
    block, W = face.block, face.W
    if not tight or block.are_independent([*W, *tight]):
        return True
    if any(combination(block, W, p) is not None for p in tight):
        return False
    if len(tight) == 1:
        return True
    _, general, rest = block.split(W)
    sides = [arb(0)] * len(general) + [arb(-1)] * len(tight)
    rows = [
        [*map(arb, dense(block.row(i).entries, rest)), side]
        for i, side in zip([*general, *tight], sides, strict=True)
    ]
    n = len(rest)
    form = matrix_form(exact_matrix(np.eye(n)), arb_mat(n, 1), rows, len(general))
    return isinstance(dual_active_set(form), Minimiser)


def free_direction(face: Face, tight: Sequence[int]) -> list[fmpz] | None:
    """A direction to another optimum, in whole numbers; None if there is none.

    Among those that P and the rows that bear leave free, it leads from no other row without slack
    to its wrong side.
    """
    block, size = face.block, len(face.N)
    if not size:
        return None
    signed = [i for i in tight if i >= block.equations]
    rows = [[along(block.row(i).entries, n) for n in face.N] for i in signed]
    rows = [row for row in rows if any(row)]
    basis, free = (fmpz_mat(rows) if rows else fmpz_mat(1, size)).nullspace()
    if free:
        w = [fmpq(basis[k, 0]) for k in range(size)]
    else:  # some row increases
        total = [sum(column, fmpz(0)) for column in zip(*rows, strict=True)]
        least = [0] * len(rows) + [1]
        exact = [[*map(arb, row), arb(-b)] for row, b in zip([*rows, total], least, strict=True)]
        form = matrix_form(exact_matrix(np.eye(size)), arb_mat(size, 1), exact, 0)
        end = dual_active_set(form)
        if not isinstance(end, Minimiser):
            return None
        w = end.fractions.exact_x
    way = fmpq_mat(fmpz_mat(face.N).transpose()) * fmpq_mat(size, 1, w)
    return shortest(way.numer_denom()[0].entries())
