"""Backends that take sparse matrices: the pattern is handed over once, then the numbers only."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import csc_matrix

from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.sparse_form import SparseForm


class Clarabel:
    """One Clarabel solver; it always starts cold."""

    def __init__(self, form: SparseForm, options: dict[str, Any]) -> None:
        import clarabel

        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.presolve_enable = False  # it would drop rows, and with them the update in place
        for name, value in options.items():
            setattr(settings, name, value)
        m = len(form.b)
        cones = [clarabel.NonnegativeConeT(m)] if m else []
        self.solver = clarabel.DefaultSolver(form.P, -form.g, -form.A, -form.b, cones, settings)

    def reply(self, form: SparseForm) -> Reply:
        """Solve a program of the same pattern."""
        self.solver.update(P=form.P.data, q=-form.g, A=-form.A.data, b=-form.b)
        solution = self.solver.solve()
        status = str(solution.status)
        solved = status == "Solved"
        return Reply(
            np.array(solution.x),
            np.array(solution.z),
            solved,
            status,
            solution.iterations,
            solution.solve_time,
        )


class Osqp:
    """One OSQP solver; it starts from the answer before."""

    def __init__(self, form: SparseForm, options: dict[str, Any]) -> None:
        import osqp

        self.solver = osqp.OSQP()
        unbounded = np.full(len(form.b), np.inf)
        self.solver.setup(P=form.P, q=-form.g, A=form.A, l=form.b, u=unbounded, **options)

    def reply(self, form: SparseForm) -> Reply:
        """Solve a program of the same pattern."""
        self.solver.update(q=-form.g, l=form.b, Px=form.P.data, Ax=form.A.data)
        result = self.solver.solve(raise_error=False)
        info = result.info
        solved = info.status == "solved"
        return Reply(
            np.array(result.x), 0.0 - result.y, solved, info.status, info.iter, info.run_time
        )


class Piqp:
    """One sparse PIQP solver; it always starts cold."""

    def __init__(self, form: SparseForm, options: dict[str, Any]) -> None:
        import piqp

        self.solver, self.solved = piqp.SparseSolver(), piqp.PIQP_SOLVED
        for name, value in options.items():
            setattr(self.solver.settings, name, value)
        self.solver.setup(whole(form.P), -form.g, None, None, form.A, form.b, None)

    def reply(self, form: SparseForm) -> Reply:
        """Solve a program of the same pattern."""
        self.solver.update(P=whole(form.P), c=-form.g, G=form.A, h_l=form.b)
        status = self.solver.solve()
        result = self.solver.result
        x, lam = np.array(result.x), np.array(result.z_l)
        return Reply(x, lam, status == self.solved, status.name, result.info.iter, None)


def whole(P: csc_matrix) -> csc_matrix:
    """The symmetric matrix of an upper triangle."""
    diagonal: Array = P.diagonal()
    whole = P + P.T
    whole.setdiag(diagonal)
    return csc_matrix(whole)
