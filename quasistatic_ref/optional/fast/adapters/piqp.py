"""PIQP, a proximal interior-point method, dense or sparse as its program is."""

import numpy as np
import piqp

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program, SparseProgram
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply


class Piqp(Adapter):
    """One PIQP solver; it always starts cold."""

    def __init__(self, program: Program | SparseProgram, options: Options) -> None:
        self.program = p = program
        dense = isinstance(p, Program)
        self.solver = piqp.DenseSolver() if dense else piqp.SparseSolver()
        if not dense:  # steps of heaps are in natural units, and take 8 % more iterations with it
            self.solver.settings.preconditioner_iter = 0
        for name, value in options.items():
            setattr(self.solver.settings, name, value)
        self.solver.setup(p.H, p.f, None, None, p.A, p.b, None)

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        del warm  # there is no such start
        p = self.program
        solver = self.solver
        solver.update(P=None if same_H else p.H, c=p.f, G=p.A, h_l=p.b)
        status = solver.solve()
        result = solver.result
        solved = status == piqp.PIQP_SOLVED
        x = np.array(result.x)
        lam = np.array(result.z_l)
        return Reply(x, lam, solved, status.name, result.info.iter, None)
