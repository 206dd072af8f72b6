"""quadprog, Goldfarb and Idnani's dual method: it keeps nothing between calls."""

import numpy as np
import quadprog

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply


class Quadprog(Adapter):
    """Calls of quadprog; it always starts cold."""

    NEAR = False  # in the default order of A, its transpose is in C order, as quadprog takes it

    def __init__(self, program: Program, options: Options) -> None:
        del options  # the method has none
        self.program = program

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        del same_H, warm  # it factorises each time, from cold
        p = self.program
        try:
            x, _, _, iterations, lam, _ = quadprog.solve_qp(
                p.H.copy(), -p.f, p.A.T, p.b
            )  # A.T: in C order
        except ValueError as error:  # infeasible, or H is not positive definite
            none = np.full(len(p.f), np.nan)
            return Reply(none, np.zeros(len(p.b)), False, str(error), None, None)
        return Reply(x, lam, True, "optimal", int(iterations[0]), None)
