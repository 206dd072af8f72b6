"""A plain quadratic program put to a solver, and its reply as it is: nothing judged, nothing mended.

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
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.standard_form import StandardForm

KEPT = 16
"""Compiled CVXPY problems that are kept, one for each number of coordinates and rows."""


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
    """One solver through CVXPY, with problems that are compiled once for each size.

    Parameters
    ----------
    solver : str
        Its name in CVXPY, in lower case.
    """

    def __init__(self, solver: str) -> None:
        self.solver = solver.upper()
        self._compiled: OrderedDict[tuple[int, ...], StepProblem] = OrderedDict()

    def reply(self, form: StandardForm, options: Options, warm: bool = False) -> Reply:
        """The reply to one problem; a warm one starts from the reply before, of the same size."""
        try:
            step = step_of(form)
            problem = self._problem(step, warm)
        except Exception as error:  # CVXPY refuses some matrices before it asks the solver
            return _raised(error, 0.0)
        begin = time.perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of statuses
            try:
                problem.fill(step)
                problem.problem.solve(solver=self.solver, warm_start=warm, **options)
            except Exception as error:  # whatever another package raises
                return _raised(error, time.perf_counter() - begin)
        seconds = time.perf_counter() - begin
        status, stats = str(problem.problem.status), problem.problem.solver_stats
        found = problem.delta_q_a.value is not None
        duals = found and all(c.dual_value is not None for c in problem.extra)
        return Reply(
            x=problem.primal() if found else None,
            lam=problem.dual() if duals else None,
            claimed=status,
            said_optimal=status == cp.OPTIMAL,
            solver_seconds=_number(stats.solve_time),
            call_seconds=seconds,
            iterations=None if stats.num_iters is None else int(stats.num_iters),
        )

    def _problem(self, step: StepData, warm: bool) -> StepProblem:
        size = step.extra.A.shape
        if size not in self._compiled:
            problem = StepProblem(step)
            problem.fill(step)
            problem.problem.get_problem_data(self.solver, solver_opts={})  # compiled, untimed
            self._compiled[size] = problem
            while len(self._compiled) > KEPT:
                self._compiled.popitem(last=False)
        self._compiled.move_to_end(size)
        if not warm:
            self._compiled[size].problem._solver_cache.clear()  # nothing is left of the last one
        return self._compiled[size]


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


def _number(value: Any) -> float | None:
    return None if value is None else float(value)
