"""A quadratic program that CVXPY compiles once, as studies need it."""

import cvxpy as cp
import numpy as np

from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.step_problem import CANON


class CompiledProblem:
    """min 1/2 x'Hx - g'x, A x >= b, of which g is a parameter.

    Parameters
    ----------
    program : Program
    name : str
        Of the backend that it is compiled for.
    """

    def __init__(self, program: Program, name: str) -> None:
        H, g, A, b, equations = program
        self.program = program
        self.x = cp.Variable(len(g))
        # H is known to be positive definite; CVXPY's check may err at condition numbers of 1e11.
        work = cp.Parameter(len(g), value=g) @ self.x
        objective = cp.quad_form(self.x, cp.psd_wrap(H)) / 2 - work
        self.rows = [A[equations:] @ self.x >= b[equations:]]
        if equations:
            self.rows.insert(0, -A[:equations] @ self.x == -b[:equations])
        self.problem = cp.Problem(cp.Minimize(objective), self.rows)
        self.problem.get_problem_data(name.upper(), canon_backend=CANON, solver_opts={})

    def primal(self) -> Array:
        """The x of the last solve, shape (n,)."""
        return np.array(self.x.value, dtype=np.float64)

    def dual(self) -> Array | None:
        """Multipliers of the problem, shape (m,), if the backend returned any."""
        parts = [row.dual_value for row in self.rows]
        if any(part is None for part in parts):
            return None
        return np.concatenate([np.ravel(part) for part in parts]).astype(np.float64)
