"""``exact_qp`` as a solver of CVXPY, by CVXPY's interface for custom solvers."""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter
from typing import Any, NamedTuple

import cvxpy.settings as words
from cvxpy.reductions.solution import Solution, failure_solution
from cvxpy.reductions.solvers.qp_solvers.qp_solver import QpSolver
from cvxpy.reductions.solvers.utilities import extract_dual_value, get_dual_values

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.qp.answer import (
    Answer,
    ExactQP,
    NoOptimum,
    QPInfeasible,
    QPNotConvex,
)
from quasistatic_ref.exact.qp.exact import exact_qp
from quasistatic_ref.exact.qp.program import program_of
from quasistatic_ref.numbers.arrays import Array

BIBTEX = "@misc{quasistatic_ref, title = {quasistatic\\_ref: exact answers of quadratic programs}}"
REMEDY = "in CVXPY, sum_squares(F @ x) takes factors F in the place of quad_form(x, F.T @ F)"


class Exact(QpSolver):  # type: ignore[misc]  # CVXPY has no types
    """A solver for CVXPY that proves what it says: ``problem.solve(solver=qr.Exact())``.

    It takes what CVXPY can compile to a quadratic or linear program, and solves exactly the program
    of float64 numbers that CVXPY hands over. Variables and dual values then have the nearest
    float64 numbers; ``problem.value`` is the objective as CVXPY evaluates it there.
    ``problem.solver_stats.extra_stats`` is the :class:`.ExactQP` of the program as compiled, which
    is one to minimise, or the proof that it is infeasible or unbounded.

    Raises
    ------
    QPNotConvex
        By ``solve``, if rounding has bent a cost; with the proof.
    InputError
        By ``solve``, if it is given options.

    Examples
    --------
    >>> import cvxpy as cp
    >>> x = cp.Variable(2)
    >>> total = cp.sum(x) == 1
    >>> problem = cp.Problem(cp.Minimize(cp.sum_squares(x) + 2 * x[0]), [total, x >= 0])
    >>> float(problem.solve(solver=qr.Exact())), x.value.tolist(), float(total.dual_value)
    (1.0, [0.0, 1.0], -2.0)
    >>> bool(qr.verify(problem.solver_stats.extra_stats))
    True
    """

    def name(self) -> str:
        """Its name in the statistics of CVXPY."""
        return "EXACT"

    def import_solver(self) -> None:
        """Nothing more is imported."""

    def cite(self, data: Mapping[str, Any]) -> str:
        """An entry of BibTeX."""
        return BIBTEX

    def apply(self, problem: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        """The data of a compiled problem, its constant among them, and what inverts an answer."""
        data, inverse = super().apply(problem)
        return {**data, words.OFFSET: inverse[words.OFFSET]}, inverse

    def solve_via_data(
        self,
        data: Mapping[str, Any],
        warm_start: bool,
        verbose: bool,
        solver_opts: Mapping[str, Any],
        solver_cache: object = None,
    ) -> Reply:
        """The answer, or the proof of none, and seconds [s]; InputError of any option."""
        for option in solver_opts:
            raise InputError("is no option; the exact solver has none", field=option)
        rows = (data[name] for name in (words.F, words.G, words.A, words.B))
        constant = float(data[words.OFFSET])
        begin = perf_counter()
        program = program_of(data[words.P], data[words.Q], *rows, None, None, constant=constant)
        try:
            answer: Answer = exact_qp(program)
        except QPNotConvex as proof:
            proof.args = (f"{proof}; {REMEDY}",)
            raise
        except NoOptimum as proof:
            answer = proof
        return Reply(answer, perf_counter() - begin)

    def invert(self, solution: Reply, inverse_data: Mapping[str, Any]) -> Any:
        """The answer as CVXPY's ``Solution``; where rows contradict each other, with factors."""
        answer = solution.answer
        attributes = {words.SOLVE_TIME: solution.seconds, words.EXTRA_STATS: answer}

        def duals(of_equations: Array, of_inequalities: Array) -> dict[int, Any]:
            equations = inverse_data[self.EQ_CONSTR]
            inequalities = inverse_data[self.NEQ_CONSTR]
            return {
                **get_dual_values(of_equations, extract_dual_value, equations),
                **get_dual_values(of_inequalities, extract_dual_value, inequalities),
            }

        if isinstance(answer, ExactQP):
            x = {inverse_data[self.VAR_ID]: answer.x}
            multipliers = duals(answer.y, answer.z)
            return Solution(words.OPTIMAL, answer.obj, x, multipliers, attributes)
        if isinstance(answer, QPInfeasible):
            return failure_solution(words.INFEASIBLE, attributes, duals(answer.y, answer.z))
        return failure_solution(words.UNBOUNDED, attributes)


class Reply(NamedTuple):
    """What the exact method says of a compiled problem, and after how many seconds [s]."""

    answer: Answer
    seconds: float
