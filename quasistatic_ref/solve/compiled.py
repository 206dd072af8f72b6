r"""The data of a solve, from the parameters of a CVXPY problem by the linear map that it compiled.

CVXPY compiles a problem to a cone program

.. math:: \min \tfrac12 x^T P x + c^T x + d \quad\text{s.t.}\quad b - A x \in K,

whose numbers are linear in the parameters; it keeps that map as sparse matrices. Before each solve
``get_problem_data`` applies them one by one, and makes sparse matrices of the numbers step by step.
Here they are applied as one matrix, to the same bits, in a twentieth of the time. Clarabel is then
called as CVXPY calls it, with what does not change formed once. That takes names private to CVXPY:
where one is missing, ``through_cvxpy`` does without this file.
"""

from __future__ import annotations

from time import perf_counter
from types import SimpleNamespace
from typing import Any

import clarabel
import cvxpy as cp
import cvxpy.settings as words
import numpy as np
import scipy.sparse as sp
from cvxpy.cvxcore.python.canonInterface import lo
from cvxpy.reductions.cvx_attr2constr import lower_value
from cvxpy.reductions.solvers.conic_solvers.clarabel_conif import CLARABEL, dims_to_solver_cones
from cvxpy.reductions.solvers.conic_solvers.conic_solver import ConicSolver
from cvxpy.reductions.solvers.solver_inverse_data import SolverInverseData

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.problem_data import ProblemData, saved
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.step_problem import StepProblem


class CompiledMap:
    """The map from the parameters of a problem to its data.

    Parameters
    ----------
    problem : cvxpy.Problem
    template : ProblemData
        Its data at any values of its parameters, which :meth:`serves`.
    """

    def __init__(self, problem: cp.Problem, template: ProblemData) -> None:
        self.problem = problem
        self.template = template
        program = template.numbers[words.PARAM_PROB]
        P, A = program.reduced_P, program.reduced_A
        rows, starts, _ = A.problem_data_index
        self.n = program.x.size
        self.P_entries = P.reduced_mat.shape[0]
        self.A_entries = int(starts[self.n])
        self.b_rows = rows[self.A_entries :]
        self.matrix = sp.vstack([P.reduced_mat, program.q.tocsr(), A.reduced_mat], format="csr")
        self.places = self._places(program)

    @staticmethod
    def serves(template: ProblemData) -> bool:
        """Whether the backend takes the cone program as it is, its quadratic cost, and rows."""
        as_it_is = type(template.chain.solver).apply is ConicSolver.apply
        return as_it_is and words.P in template.numbers and bool(template.numbers[words.A].nnz)

    def _places(self, program: Any) -> Indices:
        """Where each entry of the program's vector of parameters stands among their values.

        A matrix that is known to be symmetric counts by its upper triangle; the last entry is 1.
        """
        lowered = self.template.chain.compose_param_id_map()
        places = np.zeros(program.total_param_size + 1, dtype=np.int64)
        before = 0
        for parameter in self.problem.parameters():
            numbers = before + np.arange(parameter.size).reshape(parameter.shape)
            before += parameter.size
            entries = lower_value(parameter, numbers).ravel(order="F")
            (known_as,) = lowered.get(parameter.id, [parameter.id])
            if known_as in program.param_id_to_col:
                first = program.param_id_to_col[known_as]
                places[first : first + len(entries)] = entries
        places[program.param_id_to_col[lo.CONSTANT_ID]] = before
        return places

    def apply(self) -> tuple[Array, Array, Array, Array]:
        """Entries of P, c with d, entries of A, and b, (rows,), at the parameters' values [-]."""
        values = [parameter.value.ravel() for parameter in self.problem.parameters()]
        every = self.matrix @ np.concatenate([*values, [1.0]])[self.places]
        P, cost, rows = np.split(every, [self.P_entries, self.P_entries + self.n + 1])
        b = np.zeros(self.template.numbers[words.B].shape)
        b[self.b_rows] = rows[self.A_entries :]
        return P, cost, -rows[: self.A_entries], b

    def data(self, options: Options) -> ProblemData:
        """The data at the present values of the parameters; those of the call before change."""
        numbers = self.template.numbers
        P, cost, A, b = self.apply()
        numbers[words.P].data = P
        numbers[words.A].data = A
        last = self.template.inverse[-1].inverse_data | {words.OFFSET: cost[self.n]}
        inverse = SolverInverseData(last, self.template.chain.solver, options)
        return ProblemData(
            numbers | {words.C: cost[: self.n], words.B: b},
            self.template.chain,
            [*self.template.inverse[:-1], inverse],
        )


class ClarabelCall:
    """Clarabel, called as CVXPY calls it: with the same data, its answer in the same order.

    Parameters
    ----------
    page : StepProblem
        In a polyhedral cone: what Clarabel answers is delta_q and lam in another order.
    compiled : CompiledMap
        Of its problem.
    """

    def __init__(self, page: StepProblem, compiled: CompiledMap) -> None:
        self._compiled = compiled
        numbers = compiled.template.numbers
        P = numbers[words.P]
        numbered = sp.csc_array((np.arange(1.0, P.nnz + 1), P.indices, P.indptr), P.shape)
        self._P = sp.triu(numbered).tocsc()
        self._upper = self._P.data.astype(np.int64) - 1
        self._A = numbers[words.A].copy()
        self._cones = dims_to_solver_cones(numbers[ConicSolver.DIMS])
        self._settings: dict[tuple[object, ...], Any] = {}
        # An answer of numbers from 0 on shows where each of them belongs.
        answer = SimpleNamespace(
            status="Solved", solve_time=0.0, iterations=0, obj_val=0.0,
            x=np.arange(1.0 * P.shape[0]), z=np.arange(1.0 * self._A.shape[0]),
        )  # fmt: skip
        solution = compiled.template.chain.invert(answer, compiled.data({}).inverse)
        saved(page.problem, solution)
        self._x = page.primal().astype(np.int64)
        self._z = page.dual().astype(np.int64)

    def reply(self, options: Options) -> Reply | None:
        """The full solution at the present values of the parameters; None of anything less."""
        begin = perf_counter()
        key = tuple(options.items())
        if key not in self._settings:
            self._settings[key] = CLARABEL.parse_solver_opts(False, options)
        P, cost, self._A.data, b = self._compiled.apply()
        self._P.data = P[self._upper]
        c = cost[: self._compiled.n]
        solver = clarabel.DefaultSolver(self._P, c, self._A, b, self._cones, self._settings[key])
        raw = solver.solve()
        if str(raw.status) != CLARABEL.SOLVED:
            return None
        seconds = perf_counter() - begin
        return Reply(
            x=np.array(raw.x)[self._x],
            lam=np.array(raw.z)[self._z],
            solved=True,
            status=cp.OPTIMAL,
            iterations=int(raw.iterations),
            seconds=float(raw.solve_time),
            call_seconds=seconds,
        )
