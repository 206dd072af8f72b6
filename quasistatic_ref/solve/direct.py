"""A plain quadratic program through qpsolvers."""

from __future__ import annotations

import time
import warnings
from typing import Any

import numpy as np
import qpsolvers

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply, raised
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm


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
        Where a warm start begins [m, rad].

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
            return raised(error, time.perf_counter() - begin)
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
