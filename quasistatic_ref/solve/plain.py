"""A plain quadratic program put to a solver, and its reply as it is: not judged, not mended.

This is what studies of solvers measure. Steps of a simulation go through
:mod:`~quasistatic_ref.solve.ask`, which tries harder and believes less.
"""

from __future__ import annotations

import time
import warnings
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

import cvxpy as cp
import numpy as np
import qpsolvers

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.step.data import Array, Contacts, Extra, StepData
from quasistatic_ref.step.standard_form import StandardForm

KEPT = 2
"""Compiled CVXPY problems that are kept: one problem in raw and in natural units."""


@dataclass(frozen=True, eq=False)
class Reply:
    """What came back from one call.

    Parameters
    ----------
    x : ndarray, shape (n,), or None
        The answer to min 1/2 x'Hx - g'x, A x >= b; any shape if the solver is broken.
    lam : ndarray, shape (m,), or None
        Its multipliers.
    claimed : str
        The solver's own status, or what it raised.
    said_optimal : bool
        Whether it claims to have solved the problem.
    solver_seconds : float or None
        Time of the solver by its own account [s].
    call_seconds : float
        Time of the whole call [s].
    iterations : int or None
    """

    x: Array | None
    lam: Array | None
    claimed: str
    said_optimal: bool
    solver_seconds: float | None
    call_seconds: float
    iterations: int | None


def direct_reply(
    form: StandardForm, solver: str, options: Options, start: Array | None = None
) -> Reply:
    """The reply of a solver through qpsolvers.

    Parameters
    ----------
    form : StandardForm
    solver : str
        Its name in qpsolvers.
    options : dict
        In the solver's own names.
    start : ndarray, shape (n,), optional
        Where a warm start begins.

    Returns
    -------
    Reply
        A solver that raises has said so; this function does not.
    """
    program = qpsolvers.Problem(P=form.H.copy(), q=-form.g, G=-form.A, h=-form.b)
    initial = None if start is None else start.copy()
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of conversions to sparse, and of statuses
        try:
            solution = qpsolvers.solve_problem(program, solver, initvals=initial, **options)
        except Exception as error:  # whatever another package raises
            return _raised(error, time.perf_counter() - begin)
    seconds = time.perf_counter() - begin
    status, iterations = _status(solution)
    return Reply(
        x=None if solution.x is None else np.array(solution.x, dtype=np.float64),
        lam=None if solution.z is None else np.array(solution.z, dtype=np.float64),
        claimed=status,
        said_optimal=bool(solution.found),
        solver_seconds=None if solution.solve_time is None else float(solution.solve_time),
        call_seconds=seconds,
        iterations=iterations,
    )


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
            return _raised(error, 0.0)
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
                return _raised(error, time.perf_counter() - begin)
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


def step_of(form: StandardForm) -> StepData:
    """The step whose standard form is a given quadratic program: h = 1, K_q = H, rows as extra."""
    n, m = len(form.g), len(form.b)
    nothing, frames = np.zeros(0), np.zeros((0, 3))
    return StepData(
        h=1.0,
        K_q=form.H,
        M_u=np.zeros((0, 0)),
        tau_a=form.g,
        tau_u=nothing,
        delta_q_bar_a=np.zeros(n),
        contacts=Contacts((), nothing, frames, frames, frames, np.zeros((0, 4, n)), nothing,
                          nothing, np.zeros(0, dtype=np.int64)),
        extra=Extra(tuple(f"row {i}" for i in range(m)), form.A, form.b),
    )  # fmt: skip


def _raised(error: Exception, seconds: float) -> Reply:
    words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
    return Reply(None, None, words, False, None, seconds, None)


def _status(solution: qpsolvers.Solution) -> tuple[str, int | None]:
    """What a solver called its result, and its iterations, where qpsolvers hands them on."""
    extras = solution.extras or {}
    info = extras.get("info")
    status = extras.get("status", getattr(info, "status", None))
    iterations: Any = extras.get("iter", getattr(info, "iter", None))
    if "iterations" in extras:  # quadprog's: added, dropped
        iterations = np.ravel(extras["iterations"])[0]
    words = str(status) if status is not None else "found" if solution.found else "not found"
    return words.rpartition(".")[2], None if iterations is None else int(iterations)
