"""One step, solved: natural units, a backend, a judgement, and back to SI units."""

from __future__ import annotations

import math
import warnings
from dataclasses import asdict, dataclass

import cvxpy as cp
import numpy as np
import qpsolvers

from quasistatic_ref.certify.optimality import Residuals, optimality_residuals
from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.solve.backends import DEFAULT, QPSOLVERS, Options, backend
from quasistatic_ref.solve.units import (
    from_natural,
    natural_units,
    out_of_reach,
    to_natural,
    within_reach,
)
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY, RESIDUAL_LIMIT

CERTIFY = ("residual", "off")


@dataclass(frozen=True, eq=False)
class Answer:
    """What a solver returned, in the units that it was asked in."""

    delta_q: Array
    lam: Array
    statistics: SolverStatistics


def solve_step(
    step: StepData,
    backend: str = DEFAULT,
    *,
    accuracy: float = ACCURACY,
    certify: str = "residual",
    problem: StepProblem | None = None,
) -> StepSolution:
    """The optimum of Eq. (13).

    Parameters
    ----------
    step : StepData
        SI units.
    backend : str
        A name from :func:`~quasistatic_ref.solve.backends.installed_backends`.
    accuracy : float
        Asked of the backend, in natural units [-].
    certify : str
        ``"residual"``: refuse an answer whose residuals are not small, and report them;
        ``"off"``: take the solver's word.
    problem : StepProblem, optional
        A compiled problem of the same kind, kept by the caller between steps.

    Returns
    -------
    StepSolution

    Raises
    ------
    StepNotSolved
        If the backend claims anything but a full solution, or its answer fails the judge.
    BackendError
        If the backend is unknown or not installed.
    """
    if not accuracy > 0:
        raise InputError("must be greater than 0", field="accuracy", value=accuracy)
    if certify not in CERTIFY:
        raise InputError(f"must be one of {', '.join(CERTIFY)}", field="certify", value=certify)
    units = natural_units(step)
    natural = to_natural(step, units)
    try:
        answer = backend_answer(within_reach(natural), backend, accuracy, problem)
        # The rows that were moved nearer bear no load: the judge, who sees the true gap, decides.
        idle = np.repeat(out_of_reach(natural), step.contacts.rows)
        answer.lam[: idle.size][idle] = 0.0
        certificate = _judged(natural, answer, backend, accuracy, certify)
    except StepNotSolved as failure:
        failure.step = step  # the caller's own step, not its scaled copy
        raise
    delta_q, lam = from_natural(answer.delta_q, answer.lam, units)
    m = int(step.contacts.offsets[-1])
    return StepSolution(
        delta_q=delta_q,
        lam=lam[:m],
        lam_extra=lam[m:],
        wrench=contact_wrenches(step.contacts, lam[:m], step.h),
        backend=backend,
        certificate=certificate,
        statistics=answer.statistics,
        cone=step.cone,
    )


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
    for options in entry.attempts(accuracy):
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
    problem = StepProblem(step) if problem is None else problem
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
    program = qpsolvers.Problem(P=form.H, q=-form.g, G=-form.A, h=-form.b)
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


def _judged(
    natural: StepData, answer: Answer, name: str, accuracy: float, certify: str
) -> Certificate:
    if certify == "off":
        return Certificate("none")
    residuals: Residuals = optimality_residuals(natural, answer.delta_q, answer.lam)
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {answer.statistics.status}, but its worst residual is {worst}"
        raise StepNotSolved(name, status, natural, accuracy, residuals)
    return Certificate("residual", asdict(residuals))
