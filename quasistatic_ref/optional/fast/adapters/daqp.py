"""DAQP, a dual active-set method: H is factorised when it changes, the active set is kept.

It has dense matrices only: of a sparse program it solves each part that nothing couples.
"""

from typing import Literal

import daqp
import numpy as np

from quasistatic_ref.optional.fast.adapters.program import Adapter, Parts, Program, SparseProgram
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Daqp(Adapter):
    """A DAQP workspace, or one for each part of a sparse program that nothing couples."""

    ORDER: Literal["C", "F"] = "C"
    WARM = True
    NEAR = False

    def __init__(self, program: Program | SparseProgram, options: Options) -> None:
        self.parts: Parts | None = None
        if isinstance(program, SparseProgram):
            self.parts = Parts(program)
            programs = self.parts.programs
        else:
            programs = [program]
        self.workspaces = [Workspace(one, options) for one in programs]

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands."""
        if self.parts is None:
            return self.workspaces[0].reply(same_H, warm)
        self.parts.rewrite()
        return self.parts.joined([one.reply(same_H, warm) for one in self.workspaces])


class Workspace:
    """One dense program, and DAQP's workspace of it.

    Parameters
    ----------
    program : Program
    options : dict
        DAQP's own.
    """

    def __init__(self, program: Program, options: Options) -> None:
        self.program = p = program
        self.cold = np.zeros(len(p.b), dtype=np.int32)
        if len(p.b):
            self.model = daqp.Model()
            self.model.settings = options
            self.model.setup(p.H, p.f, p.A, np.full(len(p.b), np.inf), p.b, self.cold)

    def reply(self, same_H: bool, warm: bool) -> Reply:
        """Solve the program as it stands, from the answer before if `warm`."""
        p = self.program
        if not len(p.b):
            return p.unconstrained()
        H = None if same_H else p.H
        sense = None if warm else self.cold
        self.model.update(H=H, f=p.f, A=p.A, blower=p.b, sense=sense)
        x, _, flag, info = self.model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        status = STATUS.get(flag) or str(flag)
        return Reply(x, lam, flag == 1, status, info["iterations"], info["solve_time"])
