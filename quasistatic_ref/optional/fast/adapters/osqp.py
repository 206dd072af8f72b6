"""OSQP, operator splitting: dense A and H keep every entry in their pattern, zeros included."""

import numpy as np
import osqp

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program, SparseProgram
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply


class Osqp(Adapter):
    """One OSQP solver; warm, it starts from x and the multipliers of the step before."""

    WARM = True

    def __init__(self, program: Program | SparseProgram, options: Options) -> None:
        self.program = program
        P, A = program.columns()
        m, n = A.shape
        self.cold = np.zeros(n), np.zeros(m)
        self.solver = osqp.OSQP()
        unbounded = np.full(m, np.inf)
        self.solver.setup(P=P, q=program.f, A=A, l=program.b, u=unbounded, **options)

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        p = self.program
        solver = self.solver
        matrices = {"Ax": p.A_data}
        if not same_H:
            matrices["Px"] = p.P_data
        solver.update(q=p.f, l=p.b, **matrices)
        if not warm:
            solver.warm_start(*self.cold)
        result = solver.solve(raise_error=False)
        info = result.info
        x = np.array(result.x)
        lam = 0.0 - result.y
        solved = info.status == "solved"
        return Reply(x, lam, solved, info.status, info.iter, info.run_time)
