"""Clarabel, an interior-point method: its data are updated in place."""

import clarabel
import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program, SparseProgram
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply


class Clarabel(Adapter):
    """One Clarabel solver; it always starts cold."""

    def __init__(self, program: Program | SparseProgram, options: Options) -> None:
        self.program = program
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.presolve_enable = False  # it would drop rows, and with them the update in place
        for name, value in options.items():
            setattr(settings, name, value)
        P, A = program.columns()
        balls = program.cones if isinstance(program, Program) else 0
        flat = len(program.b) - 4 * balls
        cones = [clarabel.SecondOrderConeT(4)] * balls
        cones += [clarabel.NonnegativeConeT(flat)] if flat else []
        self.solver = clarabel.DefaultSolver(P, program.f, -A, -program.b, cones, settings)

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        del warm  # there is no such start
        p = self.program
        if not same_H:
            self.solver.update(P=p.P_data)
        self.solver.update(q=p.f, A=-p.A_data, b=-p.b)  # -A x + s = -b, s in the cones
        solution = self.solver.solve()
        status = str(solution.status)
        x = np.array(solution.x)
        lam = np.array(solution.z)
        cost = solution.solve_time
        return Reply(x, lam, status == "Solved", status, solution.iterations, cost)
