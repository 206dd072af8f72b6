r"""The data of a CVXPY problem in natural units, and its solution in the problem's units.

CVXPY compiles a problem to a cone program

.. math:: \min \tfrac12 x^T P x + q^T x \quad\text{s.t.}\quad b - A x \in K.

It keeps its form if x is :math:`\rho S` times another unknown and the rows of each constraint are
multiplied by a number. These are powers of two, found from the data alone: as in the natural units
of a step (:mod:`~quasistatic_ref.solve.units`), the diagonal of P, the rows of A and the solution
become about one, whatever a user has added to the step.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NoReturn

import cvxpy as cp
import cvxpy.settings as words
import numpy as np
import scipy.sparse as sp
from cvxpy.constraints import NonNeg, Zero
from cvxpy.reductions.reduction import Reduction
from cvxpy.reductions.solution import Solution
from cvxpy.reductions.solvers.conic_solvers.conic_solver import ConicSolver
from cvxpy.reductions.solvers.solving_chain import SolvingChain
from scipy.sparse.linalg import norm

from quasistatic_ref.errors import BackendError
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.units import coordinate_units, powers_of_two
from quasistatic_ref.tolerances import UNMOVED

if TYPE_CHECKING:
    from quasistatic_ref.solve.step_problem import ProblemData


def solve_scaled(problem: cp.Problem, data: ProblemData, options: Options) -> None:
    """Solve a problem in natural units: its status, value, variables and multipliers are then its.

    Parameters
    ----------
    problem : cvxpy.Problem
    data : ProblemData
        That of the problem.
    options : dict
        The backend's own.

    Raises
    ------
    BackendError
        If the data are of another layout than those of Clarabel, b - A x in K, or those of OSQP,
        A x = b and F x <= g.
    cvxpy.error.SolverError
        If the backend fails.
    """
    scales = Scales(data)
    solver = data.chain.solver
    chain = SolvingChain(reductions=[*data.chain.reductions[:-1], scales, solver])
    solver_options = {key: value for key, value in options.items() if key != "verbose"}
    raw = chain.solve_via_data(problem, scales.numbers, False, False, solver_options)
    with warnings.catch_warnings():
        # The status says so, too.
        warnings.filterwarnings("ignore", "Solution may be inaccurate", UserWarning)
        problem.unpack_results(raw, chain, [*data.inverse[:-1], None, data.inverse[-1]])


class Scales(Reduction):  # type: ignore[misc]  # CVXPY has no types
    """A CVXPY reduction that scales a cone program to natural units and its solution back.

    Parameters
    ----------
    data : ProblemData

    Attributes
    ----------
    numbers : dict
        The data in natural units, by CVXPY's words.
    columns : ndarray, shape (n,)
        What one of each unknown is in the problem's units.
    rows : dict of int to float
        What the multipliers of a constraint are in the problem's units, by its id.
    """

    def __init__(self, data: ProblemData) -> None:
        super().__init__()
        self.solver = data.chain.solver.name()
        inverse = data.inverse[-1]
        constraints = [*inverse[ConicSolver.EQ_CONSTR], *inverse[ConicSolver.NEQ_CONSTR]]
        heights = [sum(part.size for part in constraint.args) for constraint in constraints]
        numbers = data.numbers
        quadratic = words.F in numbers  # a QP solver's
        ends = {words.A: words.B, words.F: words.G} if quadratic else {words.A: words.B}
        q = words.Q if quadratic else words.C
        known = {*ends, *ends.values(), q} <= numbers.keys() and words.H not in numbers
        if not known or sum(numbers[end].size for end in ends.values()) != sum(heights):
            raise unknown_form(self.solver)
        A = sp.csr_array(sp.vstack([numbers[block] for block in ends]))
        b = np.concatenate([numbers[end] for end in ends.values()])
        of = np.repeat(np.arange(len(heights)), heights)  # the constraint of each row
        n = A.shape[1]
        P = sp.csc_array(numbers.get(words.P, (n, n)))

        # S: one unit for each unknown, of its cost; of those without a cost, of their rows.
        S = np.ones(n)
        costly = P.diagonal() > 0
        S[costly] = coordinate_units(P.diagonal()[costly])
        E = row_scales(_scaled(A, np.ones(len(b)), S * costly), of)
        longest = norm(_scaled(A, E[of], np.ones(n)), axis=0)
        free = ~costly & (longest > 0)
        S[free] = powers_of_two(1 / longest[free])
        E = row_scales(_scaled(A, np.ones(len(b)), S), of)

        # rho: the size of the solution, from the loads and from what is violated where x = 0.
        far = E[of] * b
        kinds = np.repeat([type(constraint) for constraint in constraints], heights)
        violated = np.where(kinds == Zero, np.abs(far), np.where(kinds == NonNeg, -far, 0.0))
        size = max(np.linalg.norm(S * numbers[q]), violated.max(initial=0.0))
        rho = float(powers_of_two(size or UNMOVED / S.max()))

        self.columns = rho * S
        self.rows = {one.id: rho * E[i] for i, one in enumerate(constraints)}
        A = _scaled(A, E[of], S).tocsc()
        self.numbers = numbers | {words.P: _scaled(P, S, S).tocsc(), q: S * numbers[q] / rho}
        first = 0
        for block, end in ends.items():
            last = first + numbers[end].size
            self.numbers |= {block: A[first:last], end: far[first:last] / rho}
            first = last
        for bound in (words.LOWER_BOUNDS, words.UPPER_BOUNDS):
            if numbers.get(bound) is not None:
                self.numbers[bound] = numbers[bound] / self.columns

    def apply(self, problem: object) -> NoReturn:
        """Refuse: CVXPY asks every reduction for this method, and calls only ``invert`` of ours.

        Raises
        ------
        NotImplementedError
            Always.
        """
        raise NotImplementedError("data are scaled when they are formed")

    def invert(self, solution: Solution, inverse_data: None) -> Solution:
        """The solution of the program whose data were scaled.

        Raises
        ------
        BackendError
            If it has no multipliers, as that of SCIP, or other unknowns than the data.
        """
        if solution.dual_vars is None:
            problem = "gives no multipliers through CVXPY; choose clarabel or osqp"
            raise BackendError(problem, field="backend", value=self.solver.lower())
        if any(np.size(x) != len(self.columns) for x in solution.primal_vars.values()):
            raise unknown_form(self.solver)
        primal = {key: np.asarray(x) * self.columns for key, x in solution.primal_vars.items()}
        dual = {key: np.asarray(y) * self.rows[key] for key, y in solution.dual_vars.items()}
        return Solution(solution.status, solution.opt_val, primal, dual, solution.attr)


def unknown_form(solver: str) -> BackendError:
    """The error for a solver whose data or answers CVXPY gives in an unknown form."""
    problem = "takes data of a form that is not known here; choose clarabel or osqp"
    return BackendError(problem, field="backend", value=solver.lower())


def _scaled(matrix: sp.csr_array, of_rows: Array, of_columns: Array) -> sp.csr_array:
    """A sparse matrix, shape (m, n), times a number of each row, (m,), and column, (n,)."""
    return sp.diags_array(of_rows) @ matrix @ sp.diags_array(of_columns)


def row_scales(A: sp.csr_array, of: Indices) -> Array:
    """Powers of two that make the rows of each constraint about one; 1 for rows of zeros.

    Parameters
    ----------
    A : sparse array, shape (m, n)
    of : ndarray of int, shape (m,)
        The constraint of each row.

    Returns
    -------
    ndarray, shape (constraints,)
    """
    lengths = norm(A, axis=1)
    scales = np.ones(1 + of.max(initial=-1))
    for i in range(len(scales)):
        present = lengths[(of == i) & (lengths > 0)]
        if present.size:
            scales[i] = powers_of_two(1 / np.median(present))
    return scales
