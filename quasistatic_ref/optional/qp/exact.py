"""``exact_qp``: the exact answer of a strictly convex quadratic program, or the proof of none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np
from flint import arb, fmpq
from numpy.typing import ArrayLike

from quasistatic_ref.certify.active_set import Combination, dual_active_set
from quasistatic_ref.certify.degeneracy import degeneracy
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import without_warnings
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.optional.qp.answer import (
    BlockOptimum,
    ExactQP,
    QPInfeasible,
    double_objective,
    joined,
)
from quasistatic_ref.optional.qp.form import Block
from quasistatic_ref.optional.qp.guess import guessed
from quasistatic_ref.optional.qp.program import HasProgram, QuadraticProgram, program_of

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Sparse(Protocol):
    """An array with `toarray`, such as a sparse array of SciPy."""

    def toarray(self) -> NDArray[np.float64]:
        """The array with all of its entries, of the same shape."""


class HasAnswer(Protocol):
    """An answer with an x, such as a ``qpsolvers.Solution``; its multipliers are read, too."""

    @property
    def x(self) -> ArrayLike | None:
        """The x at which the answer is."""


Matrix: TypeAlias = "ArrayLike | Sparse | None"


def exact_qp(
    P: ArrayLike | Sparse | HasProgram,
    q: ArrayLike | None = None,
    G: Matrix = None,
    h: ArrayLike | None = None,
    A: Matrix = None,
    b: ArrayLike | None = None,
    lb: ArrayLike | None = None,
    ub: ArrayLike | None = None,
    *,
    initvals: ArrayLike | HasAnswer | None = None,
) -> ExactQP:
    """The exact optimum of a strictly convex quadratic program, each number rounded correctly.

    Minimise 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub: the words of qpsolvers.

    Parameters
    ----------
    P : array_like or sparse, shape (n, n), or ``qpsolvers.Problem``
        Its symmetric part counts, and must be positive definite. A problem has all of the arrays.
    q : array_like, shape (n,)
    G, h : array_like, shapes (k, n) and (k,), optional
        An infinite h is no inequality.
    A, b : array_like, shapes (e, n) and (e,), optional
    lb, ub : array_like, shape (n,), optional
        Infinite where there is no bound.
    initvals : array_like, shape (n,), or an answer such as ``qpsolvers.Solution``, optional
        A guess, from which the exact method starts; by default that of DAQP or Clarabel, if one is
        installed. A wrong guess costs time, and changes nothing that is unique.

    Returns
    -------
    ExactQP

    Raises
    ------
    QPInfeasible
        If no x satisfies the rows, with the proof.
    InputError
        If P is not positive definite, without rounding; if an array is not what it should be; if
        the answer is beyond the range of float64; or if nothing can be proved in this thread.

    Examples
    --------
    >>> answer = qr.exact_qp([[1.0, 1.0], [1.0, 1.0 + 2.0**-50]], [1.0, 1.0], lb=[-0.5, -3.0])
    >>> answer.x.tolist(), answer.active, round(answer.digits([-0.500001, -0.5]))
    ([-0.5, -0.49999999999999956], ('lb[0]',), 6)
    """
    program = program_of(P, q, G, h, A, b, lb, ub)
    check_arithmetic()
    optima = []
    for block in program.blocks:
        guess = guessed(program, block, initvals)
        optima.append(without_warnings(_of_block, program, block, guess))
    fields = joined(program, optima)
    for name in ("x", "obj", "z", "y", "z_box"):
        if not np.isfinite(fields[name]).all():
            problem = f"{name} of the optimum is beyond the range of float64; choose other units"
            raise InputError(problem)
    return ExactQP(program, **fields)


def _of_block(program: QuadraticProgram, block: Block, guess: list[int]) -> BlockOptimum:
    form = block.form
    end = dual_active_set(form, guess)
    if isinstance(end, Combination):
        raise QPInfeasible(program, _proof(program, block, end))
    working = end.working
    return BlockOptimum(
        working,
        x=end.rounded(lambda point: point.x),
        y=end.rounded(lambda point: point.y),
        objective=end.rounded(lambda point: double_objective(form, working, point), arb(2)),
        unique=degeneracy(form, working, end.implied_rows, end.tight_rows)[0],
    )


def _proof(program: QuadraticProgram, block: Block, end: Combination) -> dict[str, Sequence[str]]:
    """A contradiction of rows of a block in the words of qpsolvers, its largest entry one."""
    largest = max(abs(v) for v in end.y.values())
    proof = [fmpq(0)] * sum(program.sizes.values())
    rows = program.rows
    for j, v in end.y.items():
        i = block.rows[j]
        proof[int(rows.slot[i])] += int(rows.sign[i]) * v / largest
    return program.split([str(v) for v in proof])
