"""A plain quadratic program through CVXPY."""

from __future__ import annotations

import time
import warnings
from collections import OrderedDict
from dataclasses import dataclass

import cvxpy as cp
import numpy as np

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply, raised
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

KEPT = 2
"""Compiled CVXPY problems that are kept: one problem in raw and in natural units."""


class ThroughCvxpy:
    """One solver through CVXPY, with the last few problems compiled: only g is a parameter.

    Parameters
    ----------
    solver : str
        Its name in CVXPY, in lower case.
    """

    def __init__(self, solver: str) -> None:
        self.solver = solver.upper()
        self._compiled: OrderedDict[int, _Compiled] = OrderedDict()

    def reply(self, form: StandardForm, options: Options, warm: bool = False) -> Reply:
        """The reply to one problem.

        Parameters
        ----------
        form : StandardForm
        options : dict
            In the solver's own names.
        warm : bool
            Start from the reply before, to a problem with the same H, A and b (the same arrays).

        Returns
        -------
        Reply
        """
        try:
            compiled = self._problem(form)
        except Exception as error:  # CVXPY refuses some matrices before it asks the solver
            return raised(error, 0.0)
        problem = compiled.problem
        if not warm:
            problem._solver_cache.clear()  # nothing is left of the reply before
        begin = time.perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of statuses
            try:
                compiled.g.value = form.g
                problem.solve(solver=self.solver, warm_start=warm, **options)
            except Exception as error:  # whatever another package raises
                return raised(error, time.perf_counter() - begin)
        seconds = time.perf_counter() - begin
        status, stats = str(problem.status), problem.solver_stats
        x, lam = compiled.x.value, compiled.rows.dual_value
        return Reply(
            x=None if x is None else np.array(x, dtype=np.float64),
            lam=None if lam is None else np.array(lam, dtype=np.float64),
            claimed=status,
            said_optimal=status == cp.OPTIMAL,
            solver_seconds=None if stats.solve_time is None else float(stats.solve_time),
            call_seconds=seconds,
            iterations=None if stats.num_iters is None else int(stats.num_iters),
        )

    def _problem(self, form: StandardForm) -> _Compiled:
        key = id(form.H)
        if key not in self._compiled:
            self._compiled[key] = _compiled(form, self.solver)
            while len(self._compiled) > KEPT:
                self._compiled.popitem(last=False)
        self._compiled.move_to_end(key)
        return self._compiled[key]


@dataclass(frozen=True, eq=False)
class _Compiled:
    """A problem of CVXPY's, and its parts."""

    problem: cp.Problem
    x: cp.Variable
    g: cp.Parameter
    rows: cp.Constraint
    H: Array  # kept, so that its identity stays its own


def _compiled(form: StandardForm, solver: str) -> _Compiled:
    n = len(form.g)
    x, g = cp.Variable(n), cp.Parameter(n, value=form.g)
    # H is known to be positive definite; CVXPY's own check may err at condition numbers of 1e11.
    objective = cp.quad_form(x, cp.psd_wrap(form.H)) / 2 - g @ x
    rows = form.A @ x >= form.b
    problem = cp.Problem(cp.Minimize(objective), [rows])
    problem.get_problem_data(solver, solver_opts={})
    return _Compiled(problem, x, g, rows, form.H)
