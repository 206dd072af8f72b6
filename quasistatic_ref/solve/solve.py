"""One step, solved: natural units, a solver, the judge, and back to SI units."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.certify.certificate import exact_certificate
from quasistatic_ref.certify.digits import relative_digits
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.exact_step import exact_step, relative_length, well_posed
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.compiled import compiled
from quasistatic_ref.errors import BackendError, InputError, StepIllPosed, StepNotSolved
from quasistatic_ref.optional.ellipsoid.ellipsoid import enclosure_certificate
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.optional.fast.guess.exchange import proved_nearby
from quasistatic_ref.optional.large.uncertified import uncertified_solution
from quasistatic_ref.solve.backends import DEFAULT, NONE
from quasistatic_ref.solve.engines import check_certify, solver_for
from quasistatic_ref.solve.scaled import DenseStep, out_of_range
from quasistatic_ref.solve.solver import Answer, Solver
from quasistatic_ref.solve.units import Units, from_natural, in_natural
from quasistatic_ref.step.arrays import QUIET, finite
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.solution import (
    Certificate,
    SolverStatistics,
    StepSolution,
    step_solution,
)
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import ACCURACY, ILL_POSED

LARGE = 2.0**200
"""Three such factors are far from 2^1024, where the range of float64 ends."""


def solve_step(
    step: StepData,
    solver: str | Solver = DEFAULT,
    *,
    accuracy: float = ACCURACY,
    certify: str = "full",
    extension: Extension | None = None,
) -> StepSolution:
    """The optimum of Eq. :eq:`eq-13`.

    Parameters
    ----------
    step : StepData
        SI units.
    solver : str or Solver
        A name from :func:`~quasistatic_ref.solve.backends.installed_backends`; or ``"none"``,
        with ``certify="full"`` only: the exact method from a cold start; or what
        :func:`~quasistatic_ref.solve.engines.solver_for` makes of a name: an object that holds a
        compiled problem and is kept between steps of one kind. What is certified does not depend
        on it.
    accuracy : float
        Of the backend's answer, in natural units [-].
    certify : str
        ``"full"``: the exact optimum, correctly rounded, the same bits whatever the backend said
        (in the ellipsoid, whose optimum is in general not rational, enclosed to 1e-13 or better);
        ``"residual"``: the backend's answer, refused if its residuals are not small, with a
        rigorous bound of its error; ``"off"``: the backend's answer, on its own word.
    extension : Extension, optional
        Constraints and costs of the caller's own. Linear constraints become rows of the step, and
        are certified as such; any others need a backend that takes cones, and get residuals.

    Returns
    -------
    StepSolution

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64.
    StepInfeasible
        With ``"full"``, if no displacement satisfies the rows; with the proof.
    StepIllPosed
        With ``"full"``, if the exact optimum is more than 1e6 times longer than any step that its
        loads or its penetration ask for alone; see
        :func:`~quasistatic_ref.certify.exact_step.relative_length`.
    StepNotSolved
        With ``"residual"`` and ``"off"``, if the backend claims anything but a full solution; with
        ``"residual"`` also if the judge of residuals refuses its answer. With ``"full"`` only in
        the ellipsoid, if no enclosure is found and no answer of the backend passes the judge.
    BackendError
        If the backend is unknown or not installed, or does not support `certify` or the cone.
    InputError
        If a solver object does not fit the step, if `certify` is none of these words, if
        `accuracy` is not greater than 0, or, with ``"full"`` and ``"residual"``, if nothing can
        be proved in this thread: see :mod:`~quasistatic_ref.certify.arithmetic`.
    """
    if not accuracy > 0:
        raise InputError("must be greater than 0", field="accuracy", value=accuracy)
    check_certify(solver.name if isinstance(solver, Solver) else solver, certify)
    if extension is not None:
        from quasistatic_ref.optional.extensions import (
            extended,  # needs CVXPY, which takes its time
        )

        own = extended.extension_rows(step, extension)
        if own is not None:
            step = extended.with_rows(step, own)
        elif isinstance(solver, str):
            return extended.extended_solution(step, extension, solver, accuracy, certify)
        else:
            problem = "takes linear constraints only; for a cost or a nonlinear constraint pass "
            problem += "the name of a backend, and in a simulator engine = 'cvxpy'"
            raise BackendError(problem, field="solver", value=f"{solver.name}, {solver.engine}")
    if isinstance(solver, Solver):
        solver.check(step)
    else:
        solver = solver_for(step, solver)
    return solved(step, solver, accuracy, certify)


def solved(
    step: StepData,
    solver: Solver,
    accuracy: float,
    certify: str,
    form: StandardForm | None = None,
    units: Units | None = None,
) -> StepSolution:
    """The optimum of a step that fits a solver; arguments and errors are :func:`solve_step`'s.

    Parameters
    ----------
    step, solver, accuracy, certify
        As there.
    form : StandardForm, optional
        That of the step, where the caller has it; not kept.
    units : Units, optional
        Its natural units, likewise.

    Raises
    ------
    BackendError
        If the solver does not support `certify`.
    """
    if certify != "off":
        check_arithmetic()
    if certify == "full" and not solver.certifies:
        problem = "is sparse and certifies no exact optimum; use certify = 'residual'"
        raise BackendError(problem, field="solver", value=solver.name)
    solution = QUIET.copy().run(_solved, step, solver, accuracy, certify, form, units)
    if solution is None:
        raise out_of_range(step)
    return solution


def _solved(
    step: StepData,
    solver: Solver,
    accuracy: float,
    certify: str,
    form: StandardForm | None,
    units: Units | None,
) -> StepSolution | None:
    """The solution, or None if it is not finite."""
    scaled = solver.scaled(step, form, units)
    if certify != "full" or not isinstance(scaled, DenseStep):
        solution = uncertified_solution(scaled, solver, solver.answer(scaled, accuracy), certify)
    else:
        certified = _enclosed if step.cone == ELLIPSOID else _exact
        solution = certified(scaled, solver, accuracy)
    good = finite(solution.delta_q) and finite(solution.lam)
    if certify != "off" or solution.lam_extra.size:
        residuals = np.array(list(solution.certificate.residuals.values()))
        good = good and all(map(finite, (solution.lam_extra, residuals)))
        good = good and (_far_from_largest(solution) or finite(solution.wrench.ravel()))
    return solution if good else None


def _far_from_largest(solution: StepSolution) -> bool:
    """Whether lam, mu and 1 / h are so far from the largest float64 that wrenches are finite."""
    mu, lam = solution.step.contacts.mu, solution.lam
    return bool(solution.step.h > 1 / LARGE and np.vdot(mu, mu) + np.vdot(lam, lam) < LARGE)


def _exact(scaled: DenseStep, solver: Solver, accuracy: float) -> StepSolution:
    """The exact optimum; a backend that fails costs its warm start, not the answer."""
    step = scaled.step
    answer, statistics = _attempt(scaled, solver, accuracy)
    hessian = solver.kept_hessian(step)
    norm = hessian.norm
    free = norm.impulse(scaled.form.g)
    optimum, warm = None, list[int]()
    if answer is not None:
        optimum = _proved(scaled, solver, answer, hessian)
    if optimum is None:
        if answer is not None:
            form = scaled.natural_form
            warm = warm_rows(form.A, answer.lam, form.A @ answer.delta_q - form.b)
        prove, guess = BallStep(step, hessian).confirmed, np.array(warm, dtype=np.int64)
        optimum = proved_nearby(prove, guess, scaled.form, hessian.rough)
    if optimum is None:
        optimum = exact_step(step, warm)
    else:
        well_posed(step, optimum, norm, free)
    return _certified(scaled, answer, statistics, optimum, exact_certificate, norm, free)


def _proved(
    scaled: DenseStep, solver: Solver, answer: Answer, hessian: BallHessian
) -> ExactOptimum | None:
    """The optimum proved on a working set guessed from the answer: in C, or in balls; or None."""
    step, form, fast = scaled.step, scaled.natural_form, compiled("certificate")
    if np.count_nonzero(answer.lam) > step.n_v:  # rows that depend on each other
        return None
    if fast is not None:
        solver.prover = fast.prover(step, scaled.units.coordinate, solver.prover)
    slack = form.A.dot(answer.delta_q) - form.b
    (guess,) = (answer.lam > np.maximum(slack, 0)).nonzero()  # as warm_rows has it
    if solver.prover is None:
        prove = BallStep(step, hessian).confirmed
    else:
        prove = partial(solver.prover.optimum, step, units=scaled.units)
    return proved_nearby(prove, guess, scaled.form, hessian.rough)


def _enclosed(scaled: DenseStep, solver: Solver, accuracy: float) -> StepSolution:
    """The optimum in the ellipsoid with a proved bound; where there is none, a judged answer."""
    step = scaled.step
    answer, statistics = _attempt(scaled, solver, accuracy)
    start = None
    if answer is not None:
        start = from_natural(answer.delta_q, answer.lam, scaled.units)
    found = enclosure(step, start)
    if found is None:
        if answer is None:
            status = f"{statistics.status}; and no answer strictly inside of all cones was found"
            raise StepNotSolved(solver.name, status, step, accuracy)
        return uncertified_solution(scaled, solver, answer, "residual")
    length = relative_length(step, found.delta_q)
    if not length <= ILL_POSED:
        raise StepIllPosed(step, found.delta_q, length)
    norm = energy_norm(step.H)
    free = norm.impulse(scaled.form.g)
    return _certified(scaled, answer, statistics, found, enclosure_certificate, norm, free)


def _certified(
    scaled: DenseStep,
    answer: Answer | None,
    statistics: SolverStatistics,
    optimum: Any,
    certificate: Callable[..., Certificate],
    norm: EnergyNorm,
    free: float,
) -> StepSolution:
    """A certified optimum with its residuals, and the correct digits of the backend's answer."""
    step, units, delta_q, lam = scaled.step, scaled.units, optimum.delta_q, optimum.lam
    if answer is not None:
        said, _ = from_natural(answer.delta_q, answer.lam, units)
        digits = relative_digits(norm.displacement(said - delta_q), free)
        statistics = statistics._replace(digits=digits)
    residuals = vars(scaled.residuals(*in_natural(delta_q, lam, units)))
    return step_solution(step, delta_q, lam, certificate(step, optimum, residuals), statistics)


def _attempt(
    scaled: DenseStep, solver: Solver, accuracy: float
) -> tuple[Answer | None, SolverStatistics]:
    """A backend's answer, or None and why not."""
    said = solver.name, "not called", None, None, accuracy
    statistics = SolverStatistics(*said, engine=solver.engine)
    if solver.name == NONE:
        return None, statistics
    answer = None
    try:
        answer = solver.answer(scaled, accuracy)
        statistics = answer.statistics
    except StepNotSolved as failure:
        statistics = statistics._replace(status=f"failed: {failure.status}", digits=0.0)
    check_arithmetic()  # a backend may have changed it
    return answer, statistics
