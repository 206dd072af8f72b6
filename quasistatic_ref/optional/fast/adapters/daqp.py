"""DAQP, a dual active-set method: H is factorised when it changes, the active set is kept."""

from typing import Any, Literal

import daqp
import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Adapter, Program
from quasistatic_ref.solve.reply import Reply

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Daqp(Adapter):
    """One DAQP workspace."""

    ORDER: Literal["C", "F"] = "C"
    WARM = True
    NEAR = False

    def __init__(self, program: Program, options: dict[str, Any]) -> None:
        self.program = program
        self.cold = np.zeros(len(program.b), dtype=np.int32)
        unbounded = np.full(len(program.b), np.inf)
        self.model = daqp.Model()
        self.model.settings = options
        self.model.setup(program.H, program.f, program.A, unbounded, program.b, self.cold)

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        p = self.program
        H = None if same_H else p.H
        sense = None if warm else self.cold
        self.model.update(H=H, f=p.f, A=p.A, blower=p.b, sense=sense)
        x, _, flag, info = self.model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        status = STATUS.get(flag) or str(flag)
        seconds = info["solve_time"]
        return Reply(x, lam, flag == 1, status, info["iterations"], seconds)
