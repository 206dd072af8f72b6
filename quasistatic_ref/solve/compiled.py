r"""The data of a solve, from the parameters of a CVXPY problem by the linear map that it compiled.

CVXPY compiles a problem to a cone program

.. math:: \min \tfrac12 x^T P x + c^T x + d \quad\text{s.t.}\quad b - A x \in K,

whose numbers are linear in the parameters; it keeps that map as sparse matrices. Before each solve
``get_problem_data`` applies them one by one, and makes sparse matrices of the numbers step by step.
Here they are applied as one matrix, to the same bits, in a twentieth of the time. That takes names
private to CVXPY: where one is missing, ``through_cvxpy`` does without this file.
"""

from __future__ import annotations

from typing import Any

import cvxpy as cp
import cvxpy.settings as words
import numpy as np
import scipy.sparse as sp
from cvxpy.cvxcore.python.canonInterface import lo
from cvxpy.reductions.cvx_attr2constr import lower_value
from cvxpy.reductions.solvers.conic_solvers.conic_solver import ConicSolver
from cvxpy.reductions.solvers.solver_inverse_data import SolverInverseData

from quasistatic_ref.numbers.arrays import Indices
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.problem_data import ProblemData


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

    def data(self, options: Options) -> ProblemData:
        """The data at the present values of the parameters; those of the call before change."""
        values = [parameter.value.ravel() for parameter in self.problem.parameters()]
        numbers = self.template.numbers
        P, cost, rows = np.split(
            self.matrix @ np.concatenate([*values, [1.0]])[self.places],
            [self.P_entries, self.P_entries + self.n + 1],
        )
        b = np.zeros(numbers[words.B].shape)
        b[self.b_rows] = rows[self.A_entries :]
        numbers[words.P].data = P
        numbers[words.A].data = -rows[: self.A_entries]
        last = self.template.inverse[-1].inverse_data | {words.OFFSET: cost[self.n]}
        inverse = SolverInverseData(last, self.template.chain.solver, options)
        return ProblemData(
            numbers | {words.C: cost[: self.n], words.B: b},
            self.template.chain,
            [*self.template.inverse[:-1], inverse],
        )
