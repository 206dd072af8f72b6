"""The rows that bear at the optimum of a linear program, as the basis of HiGHS names them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from quasistatic_ref.exact.time_limit import time_left

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from quasistatic_ref.exact.qp.block import Block
    from quasistatic_ref.numbers.arrays import Array

TOLERANCE: Final = 1e-9
"""What HiGHS is asked for, of rows and of reduced costs [any unit]."""

SMALL: Final = 1e-9
"""Share of a row in a sum of rows that is rounding [-]."""


class LinearModel:
    """The rows of a block, with its linear cost, as HiGHS takes them: a x >= -c.

    Parameters
    ----------
    block : Block

    Attributes
    ----------
    general : ndarray of int
        The rows of several entries.
    low, high : ndarray, shape (n,)
        The limits of coordinates.
    of_low, of_high : ndarray of int, shape (n,)
        The rows that these are of; -1 where there is none.
    """

    def __init__(self, block: Block) -> None:
        self.block = block
        self.general = np.flatnonzero(block.entries.counts > 1)
        self.low, self.high = np.full(block.n, -np.inf), np.full(block.n, np.inf)
        self.of_low, self.of_high = np.full((2, block.n), -1)
        for i in np.flatnonzero(block.entries.counts == 1).tolist():
            (j,), (v,) = (part.tolist() for part in block.entries.entries(i))
            limit = -block.c[i] / v
            equation = i < block.equations
            if (equation or v > 0) and limit > self.low[j]:
                self.low[j], self.of_low[j] = limit, i
            if (equation or v < 0) and limit < self.high[j]:
                self.high[j], self.of_high[j] = limit, i

    def solver(self, cost: Array, **options: Any) -> Any:
        """HiGHS after its run, of cost, shape (n,) [any unit]; ImportError without it."""
        highspy = import_module("highspy")
        block, general = self.block, self.general
        model = highspy.HighsLp()
        model.num_col_, model.num_row_ = block.n, len(general)
        model.col_cost_ = cost
        model.col_lower_, model.col_upper_ = self.low, self.high
        model.row_lower_ = -block.c[general]
        model.row_upper_ = np.where(general < block.equations, -block.c[general], np.inf)
        rows = block.entries.some(general, np.arange(block.n))
        matrix = model.a_matrix_
        matrix.format_ = highspy.MatrixFormat.kRowwise
        matrix.start_ = rows.start.astype(np.int32)
        matrix.index_ = rows.column.astype(np.int32)
        matrix.value_ = rows.value
        solver = highspy.Highs.__base__()  # the class itself prints its version
        for name, value in {
            "output_flag": False,
            "parallel": "off",  # to name a number of threads fails after calls with another
            "primal_feasibility_tolerance": TOLERANCE,
            "dual_feasibility_tolerance": TOLERANCE,
            "time_limit": time_left(),
            **options,
        }.items():
            solver.setOptionValue(name, value)
        solver.passModel(model)
        solver.run()
        return solver


def basis_rows(block: Block) -> tuple[list[int], Array] | None:
    """The inequalities that bear at HiGHS's basis, and x, (n,); None if it has no optimum."""
    model = LinearModel(block)
    solver = model.solver(block.program.q[block.coordinates])
    highspy = import_module("highspy")
    if solver.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None
    basis, solution = solver.getBasis(), solver.getSolution()
    at_basis = highspy.HighsBasisStatus.kBasic
    held = np.array([status != at_basis for status in basis.row_status], dtype=bool)
    free = np.array([status == at_basis for status in basis.col_status], dtype=bool)
    high = np.array([status == highspy.HighsBasisStatus.kUpper for status in basis.col_status])
    general = model.general[held]
    of_bound = np.where(high, model.of_high, model.of_low)[~free]
    rows = np.concatenate([general, of_bound])
    y = np.concatenate([np.array(solution.row_dual)[held], np.array(solution.col_dual)[~free]])
    y[len(general) :] *= np.where(high[~free], -1.0, 1.0)
    of_basic = model.of_low[free]  # a fixed coordinate may be basic, too
    outside = np.append(model.general[~held], of_basic[of_basic >= 0])
    equations = outside[outside < block.equations]
    in_basis, fixed = np.flatnonzero(free), np.flatnonzero(~free)
    a, of_equations = (block.entries.some(some, in_basis).dense() for some in (general, equations))
    b, beside = (block.entries.some(some, fixed).dense() for some in (general, equations))
    try:
        of_general = np.linalg.solve(a.T, of_equations.T)
    except np.linalg.LinAlgError:
        return None
    of_bounds = beside.T - b.T @ of_general
    of_bounds[high[~free]] *= -1.0
    bear = rows >= block.equations
    chosen = with_equations(y[bear], np.concatenate([of_general, of_bounds])[bear])
    order = np.argsort(-y[bear], kind="stable")
    return rows[bear][order[chosen[order]]].tolist(), np.array(solution.col_value)


def with_equations(y: Array, shares: Array) -> NDArray[np.bool_]:
    """Which inequalities of a basis stay where equations outside of it come in.

    Each takes the place of the inequality whose multiplier is zero first as its own grows or falls.

    Parameters
    ----------
    y : ndarray, shape (k,)
        Multipliers of inequalities of the basis [any unit].
    shares : ndarray, shape (k, e)
        Of each of them in the sum of rows of the basis that an equation is [any unit].

    Returns
    -------
    ndarray of bool, shape (k,)
    """
    y, shares = np.maximum(y, 0.0), shares.copy()
    stay = np.full(len(y), True)
    for p in range(shares.shape[1]):
        share = np.where(stay & (np.abs(shares[:, p]) > SMALL), shares[:, p], 0.0)
        if not share.any():
            continue  # it depends on equations of the basis
        ratio = np.divide(y, np.abs(share), out=np.full(len(y), np.inf), where=share != 0)
        i = int(ratio.argmin())
        y = np.maximum(y - y[i] / share[i] * share, 0.0)
        shares[:, p:] -= np.outer(share / share[i], shares[i, p:])
        stay[i] = False
    return stay
