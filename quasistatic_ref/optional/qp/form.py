"""A program in exact numbers, by the blocks that nothing couples; and what makes P unfit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np
from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.form import (
    EXACT,
    MatrixForm,
    exact_matrix,
    whole_numbers,
)
from quasistatic_ref.certify.groups import labels
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.pivots import positive_pivots
from quasistatic_ref.numbers.precision import nearest_fraction, working_precision

if TYPE_CHECKING:
    from quasistatic_ref.optional.qp.program import QuadraticProgram

MOST_TERMS = 6
"""Terms of a direction that a sentence shows."""


@dataclass(frozen=True, eq=False)
class Block:
    """A part of a program that nothing couples to the rest.

    Parameters
    ----------
    coordinates, rows : ndarray of int, shapes (n,) and (m,)
        Which ones of the program these are.
    form : MatrixForm
    """

    coordinates: Indices
    rows: Indices
    form: MatrixForm


def blocks_of(program: QuadraticProgram) -> list[Block]:
    """The blocks of a program, in the order of their first coordinates.

    Raises
    ------
    InputError
        If P is singular or indefinite.
    """
    rows = program.rows
    P = program.P
    coupled = (P != 0) | (P.T != 0) | np.eye(len(P), dtype=bool)
    coordinate, row = labels(np.concatenate([coupled, rows.a != 0]))
    blocks = []
    for first in np.unique(coordinate):
        at = np.flatnonzero(coordinate == first)
        of = np.flatnonzero(row[len(P) :] == first)
        block = P[np.ix_(at, at)]
        with working_precision(EXACT):
            half = exact_matrix(block)
            symmetric = half * arb(0.5) + half.transpose() * arb(0.5)
        _check_definite(block, symmetric, at)
        equations = int((of < rows.equations).sum())
        of_rows = np.column_stack([rows.a[np.ix_(of, at)], rows.c[of]])
        q = exact_matrix(-program.q[at, None])
        form = MatrixForm(symmetric, q, exact_matrix(of_rows), equations=equations)
        blocks.append(Block(at, of, form))
    return blocks


def _check_definite(P: Array, exact: arb_mat, coordinates: Indices) -> None:
    if np.array_equal(P, P.T) and positive_pivots(P):
        return
    S = fmpz_mat(len(P), len(P), whole_numbers(exact.entries()))
    x = costless(S)
    if x is not None:
        pull = (S * fmpz_mat(len(x), 1, x)).entries()
        cost = sum((v * w for v, w in zip(x, pull, strict=True)), fmpz(0))
        word = "indefinite" if any(pull) else "singular"
        costs = "less than nothing" if cost else "nothing"
        raise InputError(
            f"P is {word}: {_in_words(x, coordinates)} costs {costs}; "
            "exact_qp takes a P that is positive definite"
        )


def costless(S: fmpz_mat) -> list[fmpz] | None:
    """An x != 0 with x'Sx <= 0; None if the symmetric S is positive definite.

    The first leading block of S whose determinant is not positive has one. With p its last column
    and B the block before, which is positive definite, it is x = [-B^-1 p; 1].
    """
    n = S.nrows()
    permutation, _, _, minors = S.fflu()  # as Bareiss: the pivots are leading minors of S
    for k in range(n):
        if permutation[k, k] != 1 or minors[k, k] <= 0:
            break
    else:
        return None
    if not k:
        return [fmpz(1), *[fmpz(0)] * (n - 1)]
    B = fmpz_mat(k, k, [S[i, j] for i in range(k) for j in range(k)])
    p = fmpz_mat(k, 1, [-S[i, k] for i in range(k)])
    numerators, denominator = cast("fmpq_mat", B.solve(p)).numer_denom()
    return [*numerators.entries(), denominator, *[fmpz(0)] * (n - k - 1)]


def _in_words(direction: Sequence[fmpz], coordinates: Indices) -> str:
    """A direction as ``x_3 - x_7``."""
    named = [(int(i), v) for i, v in zip(coordinates, direction, strict=True) if v]
    _, first = named[0]
    words = ""
    for i, v in named[:MOST_TERMS]:
        share = nearest_fraction(fmpq(v, first))
        factor = "" if abs(share) == 1 else f"{abs(share):.6g} "
        words += f" {'-' if share < 0 else '+'} {factor}x_{i}"
    return words.removeprefix(" + ") + (" + ..." if len(named) > MOST_TERMS else "")
