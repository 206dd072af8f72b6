"""``exact_qp``: the exact answer of a convex quadratic program, or the proof that there is none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias
from warnings import warn

import numpy as np
from flint import arb, fmpq, fmpq_mat
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.qp.answer import ExactQP, QPInfeasible, QPNotConvex, QPUnbounded
from quasistatic_ref.exact.qp.block import Block, Convex, blocks_of
from quasistatic_ref.exact.qp.convexity import Indefinite, convex_cost
from quasistatic_ref.exact.qp.face import BITS
from quasistatic_ref.exact.qp.guess import guessed
from quasistatic_ref.exact.qp.numbers import as_fraction, exact_numbers, fraction_matrix
from quasistatic_ref.exact.qp.program import HasAnswer, HasProgram, QuadraticProgram, program_of
from quasistatic_ref.exact.qp.search import (
    BlockOptimum,
    Contradiction,
    Endless,
    feasible_point,
    objective_of,
    optimum,
)
from quasistatic_ref.exact.time_limit import time_limit
from quasistatic_ref.numbers.arrays import positive_number, without_warnings
from quasistatic_ref.numbers.precision import (
    all_nearest,
    check_arithmetic,
    nearest_fraction,
    working_precision,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Sparse(Protocol):
    """An array with `toarray`, such as a sparse array of SciPy."""

    def toarray(self) -> NDArray[np.float64]:
        """The array with all of its entries, of the same shape."""


Matrix: TypeAlias = "ArrayLike | Sparse | None"


def exact_qp(
    P: ArrayLike | Sparse | HasProgram | QuadraticProgram,
    q: ArrayLike | None = None,
    G: Matrix = None,
    h: ArrayLike | None = None,
    A: Matrix = None,
    b: ArrayLike | None = None,
    lb: ArrayLike | None = None,
    ub: ArrayLike | None = None,
    *,
    initvals: ArrayLike | HasAnswer | None = None,
    seconds: float | None = None,
) -> ExactQP:
    """The exact optimum of a convex quadratic program, each number rounded correctly.

    Minimise 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub: the words of qpsolvers.
    Of several optima, the one of least norm. Numbers may be fractions, or texts: ``"0.1"`` is a
    tenth, and whole numbers of any size are themselves.

    Parameters
    ----------
    P : array_like or sparse, shape (n, n), ``qpsolvers.Problem`` or what :func:`.load_qp` gives
        Symmetric but for rounding, which its symmetric part removes; positive semidefinite where
        equations and fixed variables let something move. A problem has all of the arrays.
    q : array_like, shape (n,)
    G, h : array_like, shapes (k, n) and (k,), optional
        An infinite h is no inequality.
    A, b : array_like, shapes (e, n) and (e,), optional
    lb, ub : array_like, shape (n,), optional
        Infinite where there is no bound.
    initvals : array_like, shape (n,), or an answer such as ``qpsolvers.Solution``, optional
        A guess, from which the exact method starts; by default that of DAQP, HiGHS
        or Clarabel, if one is installed. A wrong guess costs time, and changes nothing that is
        unique.
    seconds : float, optional
        After which TimeIsUp is raised; an elimination that has begun ends first [s].

    Returns
    -------
    ExactQP

    Raises
    ------
    QPInfeasible, QPUnbounded, QPNotConvex
        If no x satisfies the rows, the cost falls without end, or P is not convex: with the proof.
    TimeIsUp
        If it takes longer than `seconds`.
    InputError
        If an array is not what it should be; if the answer is beyond the range of float64; or if
        nothing can be proved in this thread.

    Warns
    -----
    UserWarning
        If a limit of 1e20 or more, which others take for infinite, holds x.

    Examples
    --------
    >>> answer = qr.exact_qp([[1.0, 1.0], [1.0, 1.0 + 2.0**-50]], [1.0, 1.0], lb=[-0.5, -3.0])
    >>> answer.x.tolist(), answer.active, round(answer.digits([-0.500001, -0.5]))
    ([-0.5, -0.49999999999999956], ('lb[0]',), 6)
    """
    if seconds is not None:
        seconds = positive_number(seconds, "seconds")
    with time_limit(seconds):
        return _answer(program_of(P, q, G, h, A, b, lb, ub), initvals)


def exact_ls(
    R: ArrayLike | Sparse,
    s: ArrayLike,
    G: Matrix = None,
    h: ArrayLike | None = None,
    A: Matrix = None,
    b: ArrayLike | None = None,
    lb: ArrayLike | None = None,
    ub: ArrayLike | None = None,
    W: Matrix = None,
    *,
    q: ArrayLike | None = None,
    D: Matrix = None,
    initvals: ArrayLike | HasAnswer | None = None,
) -> ExactQP:
    """The exact optimum of a cost by factors: as :func:`.exact_qp`, with P formed without rounding.

    Minimise 1/2 (R x - s)'W (R x - s) + 1/2 x'Dx + q'x, as ``qpsolvers.solve_ls`` does without D
    and q. A covariance X'X of fewer samples than assets is singular so, and not indefinite.

    Parameters
    ----------
    R, s : array_like, shapes (r, n) and (r,)
    G, h, A, b, lb, ub, initvals
        As of :func:`.exact_qp`.
    W : array_like, shape (r, r), optional
        Of each residual one by default.
    q : array_like, shape (n,), optional
    D : array_like, shape (n, n) or (n,), optional
        A vector is a diagonal.

    Returns
    -------
    ExactQP

    Raises
    ------
    QPInfeasible, QPUnbounded, QPNotConvex, InputError
        As of :func:`.exact_qp`.

    Examples
    --------
    >>> qr.exact_ls([["0.1", "0.7"]], [1.0], lb=[0.0, 0.0]).x.tolist()
    [0.2, 1.4]
    """
    of_R, of_s = fraction_matrix(R, "R"), fraction_matrix(s, "s")
    r, n = of_R.nrows(), of_R.ncols()
    of_s = fmpq_mat(of_s.nrows() * of_s.ncols(), 1, of_s.entries())
    of_W = None if W is None else fraction_matrix(W, "W")
    if of_s.nrows() != r or (of_W is not None and (of_W.nrows(), of_W.ncols()) != (r, r)):
        raise InputError(f"must be of {r} residuals, as many as R has rows", field="s or W")
    weighed = of_R.transpose() if of_W is None else of_R.transpose() * of_W
    P, slope = weighed * of_R, weighed * of_s
    size = (of_s.transpose() * (of_s if of_W is None else of_W * of_s))[0, 0]
    if D is not None:
        add = fraction_matrix(D, "D")
        if (add.nrows(), add.ncols()) not in ((n, n), (1, n), (n, 1)):
            problem = f"must be a diagonal of {n} numbers, or {n} x {n}"
            raise InputError(problem, field="D", value=(add.nrows(), add.ncols()))
        if (add.nrows(), add.ncols()) != (n, n) or n == 1:
            add = fmpq_mat(
                [[v * int(i == j) for j in range(n)] for i, v in enumerate(add.entries())]
            )
        P = P + add
    linear = [fmpq(0)] * n if q is None else fraction_matrix(q, "q").entries()
    if len(linear) != n:
        raise InputError(f"must be {n} numbers", field="q", value=len(linear))
    arrays = (
        [[*map(as_fraction, row)] for row in P.tolist()],
        [as_fraction(v - w) for v, w in zip(linear, slope.entries(), strict=True)],
    )
    program = program_of(*arrays, G, h, A, b, lb, ub, constant=as_fraction(size / 2))
    return _answer(program, initvals)


def exact_lp(
    c: ArrayLike,
    A_ub: Matrix = None,
    b_ub: ArrayLike | None = None,
    A_eq: Matrix = None,
    b_eq: ArrayLike | None = None,
    bounds: Any = (0, None),
    integrality: ArrayLike | None = None,
) -> ExactQP:
    """The exact optimum of a linear program, of least norm, in the words of SciPy's ``linprog``.

    Minimise c'x subject to A_ub x <= b_ub, A_eq x = b_eq and bounds, which are x >= 0 if they are
    left out. It is ``exact_qp`` with P = 0; of several optima, x is generally no vertex.

    Parameters
    ----------
    c, A_ub, b_ub, A_eq, b_eq : array_like
        Shapes (n,), (k, n), (k,), (e, n) and (e,).
    bounds : sequence of (least, most), or one such pair for all
        None or NaN where there is none.
    integrality
        Refused unless it is zero.

    Returns
    -------
    ExactQP

    Raises
    ------
    QPInfeasible, QPUnbounded, InputError
        As of :func:`.exact_qp`.

    Examples
    --------
    >>> qr.exact_lp([-1.0, -2.0], A_ub=[[1.0, 1.0]], b_ub=["0.1"]).obj
    -0.2
    """
    if integrality is not None and _objects(integrality, "integrality").any():
        raise InputError("is for whole numbers, which are not solved for", field="integrality")
    n = exact_numbers(c, "c")[0].size
    pairs = np.array((0, None), dtype=object) if bounds is None else _objects(bounds, "bounds")
    if not pairs.size:
        pairs = np.array((0, None), dtype=object)
    if pairs.shape not in ((2,), (1, 2), (n, 2)) or any(map(np.ndim, pairs.ravel())):
        raise InputError(f"must be a pair, or {n} pairs", field="bounds", value=pairs.shape)
    limits = [
        [end if v is None or v != v else v for v in column]
        for column, end in zip(np.broadcast_to(pairs, (n, 2)).T, (-np.inf, np.inf), strict=True)
    ]
    return exact_qp(np.zeros((n, n)), c, A_ub, b_ub, A_eq, b_eq, *limits)


def _objects(value: Any, name: str) -> NDArray[Any]:
    """An array of whatever nested lists hold; InputError if these are of several lengths."""
    try:
        return np.array(value, dtype=object)
    except ValueError:
        raise InputError("must be lists of equal length", field=name, value=value) from None


def _answer(program: QuadraticProgram, initvals: Any) -> ExactQP:
    check_arithmetic()
    blocks = blocks_of(program)
    costs = [without_warnings(_convex, program, block) for block in blocks]
    optima: list[BlockOptimum] = []
    endless: tuple[Block, Endless] | None = None
    for block, convex in zip(blocks, costs, strict=True):
        try:
            optima.append(without_warnings(_of_block, program, block, convex, initvals))
        except Contradiction as end:
            raise QPInfeasible(program, _proof(program, block, end)) from None
        except Endless as end:
            endless = block, end
    if endless is not None:
        raise _unbounded(program, blocks, *endless)
    fields = _fields(program, blocks, costs, optima)
    for name in ("x", "obj", "z", "y", "z_box"):
        if not np.isfinite(fields[name]).all():
            problem = f"{name} of the optimum is beyond the range of float64; choose other units"
            raise InputError(problem)
    answer = ExactQP(program, **fields)
    if answer.remark:
        warn(answer.remark, stacklevel=3)
    return answer


def _fields(
    program: QuadraticProgram,
    blocks: Sequence[Block],
    costs: Sequence[Convex],
    optima: Sequence[BlockOptimum],
) -> dict[str, Any]:
    """The fields of an answer, but its problem, from the optima of its blocks."""
    names = program.rows.names
    n = len(program.q)
    x, of_rows = np.zeros(n), np.zeros(len(names))
    active: list[int] = []
    least: list[int] = []
    direction: list[str] = []
    for block, best in zip(blocks, optima, strict=True):
        held = block.rows[[*best.working]]
        x[block.coordinates] = best.x
        of_rows[held] = best.y
        active += held.tolist()
        least += block.rows[[*best.least]].tolist()
        if best.direction is not None and not direction:
            direction = [*map(str, block.spread(best.direction, 0))]
    obj = _objective(program, blocks, costs, optima)
    ulp = float(np.spacing(abs(obj)))
    return {
        "x": x,
        **program.multipliers(of_rows),
        "obj": obj,
        "obj_error": ulp / 2 or ulp,  # half of the least number is zero
        "active": tuple(names[i] for i in sorted(active)),
        "multipliers_unique": all(best.unique for best in optima),
        "least_norm": tuple(names[i] for i in sorted(least)),
        "direction": tuple(direction),
    }


def _objective(
    program: QuadraticProgram,
    blocks: Sequence[Block],
    costs: Sequence[Convex],
    optima: Sequence[BlockOptimum],
) -> float:
    """The objective, rounded once: in balls, or where these do not tell in whole numbers."""
    constant = fmpq(*program.exact.get("constant", {}).get(0, program.constant).as_integer_ratio())
    with working_precision(BITS):
        balls = all_nearest([sum((arb(best.objective) for best in optima), arb(constant))])
    if balls is not None and any(isinstance(best.objective, arb) for best in optima):
        return balls[0]
    parts = zip(blocks, costs, optima, strict=True)
    return nearest_fraction(sum((objective_of(*part) for part in parts), constant))


def _convex(program: QuadraticProgram, block: Block) -> Convex:
    try:
        return convex_cost(block)
    except Indefinite as found:
        raise QPNotConvex(program, [*map(str, block.spread(found.direction, 0))]) from None


def _of_block(
    program: QuadraticProgram, block: Block, convex: Convex, initvals: Any
) -> BlockOptimum:
    return optimum(block, convex, guessed(program, block, initvals))


def _proof(program: QuadraticProgram, block: Block, end: Contradiction) -> dict[str, str]:
    """The factors of rows that contradict each other, the largest one."""
    largest = max(abs(v) for v in end.factors.values())
    names = program.rows.names
    by_name = {names[block.rows[i]]: v / largest for i, v in sorted(end.factors.items()) if v}
    return {name: str(-v if name.startswith("A[") else v) for name, v in by_name.items()}


def _unbounded(
    program: QuadraticProgram, blocks: Sequence[Block], endless: Block, end: Endless
) -> QPUnbounded:
    """The proof that a program is unbounded: a direction of one block, at a feasible point."""
    x = [fmpq(0)] * len(program.q)
    for block in blocks:
        point = end.x if block is endless else without_warnings(feasible_point, block)
        for j, v in zip(block.coordinates.tolist(), point, strict=True):
            x[j] = v
    direction = endless.spread(end.direction, 0)
    return QPUnbounded(program, [*map(str, x)], [*map(str, direction)])
