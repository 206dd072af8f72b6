"""quadprog, Goldfarb and Idnani's dual method: it keeps nothing between calls."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import quadprog

from quasistatic_ref.solve.adapters.program import Program, Reply


class Quadprog:
    """Calls of quadprog; it always starts cold."""

    ORDER: Literal["C", "F"] = "F"  # it takes the transpose of A in C order
    WARM = False
    NEAR = False

    def __init__(self, program: Program, options: dict[str, Any]) -> None:
        del options  # the method has none
        self.program = program

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        del same_H, warm  # it factorises each time, from cold
        p = self.program
        try:
            x, _, _, iterations, lam, _ = quadprog.solve_qp(p.H.copy(), -p.f, p.A.T, p.b)
        except ValueError as error:  # infeasible, or H is not positive definite
            none = np.full(len(p.f), np.nan)
            return Reply(none, np.zeros(len(p.b)), False, str(error), None, None)
        return Reply(x, lam, True, "optimal", int(iterations[0]), None)
