"""Asking a backend: a step in, whatever the solver says out, in the units it was asked in."""

from __future__ import annotations

import warnings

import cvxpy as cp
import numpy as np
import qpsolvers

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.solve.answer import Answer
from quasistatic_ref.solve.backends import QPSOLVERS, Options, backend
from quasistatic_ref.solve.cone_problem import cone_problem
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.solution import SolverStatistics
from quasistatic_ref.step.standard_form import standard_form

RELAXED = (1.0, 1e2, 1e4)
"""Accuracies tried in the ellipsoid, relative to the one asked for.

Second-order cones cost Clarabel digits: of 40 planted steps it solves none at 1e-12, 39 at 1e-10
and all at 1e-9; of 40 grasp steps 37 at 1e-12 and all at 1e-11."""


def backend_answer(
    step: StepData, name: str, accuracy: float, problem: StepProblem | None = None
) -> Answer:
    """What a backend says to a step, taken as it is given, in the units of the step.

    Raises
    ------
    StepNotSolved
        If it says anything but a full solution, or the numbers are not finite.
    """
    road = _through_qpsolvers if name.startswith(QPSOLVERS) else _through_cvxpy
    failure: StepNotSolved | None = None
    entry = backend(name)
    accuracy = max(accuracy, entry.floor)
    asked = [k * accuracy for k in (RELAXED if step.cone == ELLIPSOID else (1.0,))]
    for accuracy, options in [(a, options) for a in asked for options in entry.attempts(a)]:
        try:
            answer = road(step, name, options, accuracy, problem)
        except StepNotSolved as failed:
            failure = failed
            continue
        if np.isfinite(answer.delta_q).all() and np.isfinite(answer.lam).all():
            return answer
        failure = StepNotSolved(name, "an answer that is not finite", step, accuracy)
    assert failure is not None  # a backend has at least one set of options
    raise failure


def _through_cvxpy(
    step: StepData, name: str, options: Options, accuracy: float, problem: StepProblem | None
) -> Answer:
    problem = cone_problem(step) if problem is None or not problem.fits(step) else problem
    problem.fill(step)
    with warnings.catch_warnings():
        # "Solution may be inaccurate" is dealt with below, by the status.
        warnings.filterwarnings("ignore", "Solution may be inaccurate", UserWarning)
        try:
            # Cold, so that a step replayed by itself takes the same path. (PROXQP's interface
            # in CVXPY raises TypeError on a second warm start anyway.)
            problem.problem.solve(solver=name.upper(), warm_start=False, **options)
        except Exception as error:  # whatever another package raises
            raise StepNotSolved(name, f"the solver failed: {error}", step, accuracy) from error
    status = str(problem.problem.status)
    if status != cp.OPTIMAL:
        raise StepNotSolved(name, status, step, accuracy)
    stats = problem.problem.solver_stats
    statistics = SolverStatistics(name, status, stats.num_iters, stats.solve_time, accuracy)
    return Answer(problem.primal(), problem.dual(), statistics)


def _through_qpsolvers(
    step: StepData, name: str, options: Options, accuracy: float, problem: StepProblem | None
) -> Answer:
    del problem  # this road needs no CVXPY
    form = standard_form(step)
    program = qpsolvers.Problem(P=form.H.copy(), q=-form.g, G=-form.A, h=-form.b)
    with warnings.catch_warnings():
        # It warns of dense matrices converted (13 x 80 numbers), of defaults that will change,
        # and of statuses, which are dealt with below.
        warnings.simplefilter("ignore")
        try:
            solution = qpsolvers.solve_problem(program, name.removeprefix(QPSOLVERS), **options)
        except Exception as error:  # whatever another package raises
            raise StepNotSolved(name, f"the solver failed: {error}", step, accuracy) from error
    if not solution.found or solution.x is None or solution.z is None:
        raise StepNotSolved(name, "no solution found", step, accuracy)
    return Answer(
        np.array(solution.x),
        np.array(solution.z).reshape(-1),
        SolverStatistics(name, "optimal", None, solution.solve_time, accuracy),
    )
