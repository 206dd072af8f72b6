"""One step, solved: natural units, a backend, the judge, and back to SI units."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from quasistatic_ref.certify.bound import error_bound
from quasistatic_ref.certify.certificate import exact_certificate
from quasistatic_ref.certify.digits import correct_digits
from quasistatic_ref.certify.ellipsoid import enclosure_certificate
from quasistatic_ref.certify.enclosure import enclosure
from quasistatic_ref.certify.exact_step import exact_step, relative_length
from quasistatic_ref.certify.optimality import Residuals, ellipsoid_residuals, optimality_residuals
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import (
    BackendError,
    InputError,
    StepIllPosed,
    StepNotSolved,
)
from quasistatic_ref.solve.answer import Answer
from quasistatic_ref.solve.ask import backend_answer
from quasistatic_ref.solve.backends import DEFAULT, NONE, cone_backend
from quasistatic_ref.solve.engines import CVXPY, NATIVE, check_engine
from quasistatic_ref.solve.extended import extended_solution, extension_rows, with_rows
from quasistatic_ref.solve.native import NativeProblem, check_native
from quasistatic_ref.solve.problems import Problem
from quasistatic_ref.solve.scaled import Scaled, out_of_range
from quasistatic_ref.solve.sparse import SparseProblem
from quasistatic_ref.solve.units import Units, from_natural, out_of_reach, within_reach
from quasistatic_ref.step.arrays import QUIET, finite
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY, ILL_POSED, RESIDUAL_LIMIT

CERTIFY = ("full", "residual", "off")
NOTHING_CLAIMED = Certificate("none")


def solve_step(
    step: StepData,
    backend: str = DEFAULT,
    *,
    engine: str = CVXPY,
    accuracy: float = ACCURACY,
    certify: str = "full",
    problem: Problem | None = None,
    extension: Extension | None = None,
) -> StepSolution:
    """The optimum of Eq. :eq:`eq-13`.

    Parameters
    ----------
    step : StepData
        SI units.
    backend : str
        A name from :func:`~quasistatic_ref.solve.backends.installed_backends`; or ``"none"``,
        with ``certify="full"`` only: the exact method from a cold start.
    engine : str
        ``"cvxpy"``: through the problem of :mod:`~quasistatic_ref.step.problem`; or ``"native"``:
        the standard form through the solver's own interface, some ten times faster. What is
        certified does not depend on it.
    accuracy : float
        Asked of the backend, in natural units [-].
    certify : str
        ``"full"``: the exact optimum, correctly rounded, the same bits whatever the backend said
        (in the ellipsoid, which has no rational optimum, enclosed to 1e-13 or better);
        ``"residual"``: the backend's answer, refused if its residuals are not small, with a
        rigorous bound of its error; ``"off"``: the backend's answer, on its own word.
    problem : StepProblem or NativeProblem, optional
        Of the same kind of step and of the engine, kept by the caller between steps.
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
        With ``"full"``, if the exact optimum is absurd.
    StepNotSolved
        Otherwise, if the backend claims anything but a full solution, or fails the judge.
    BackendError
        If the backend is unknown or not installed, or the engine does not reach it.
    InputError
        If `certify` or `engine` is no such word, or `accuracy` not greater than 0.
    """
    check_engine(engine)
    if not accuracy > 0:
        raise InputError("must be greater than 0", field="accuracy", value=accuracy)
    if certify not in CERTIFY:
        raise InputError(f"must be one of {', '.join(CERTIFY)}", field="certify", value=certify)
    if extension is not None:
        own = extension_rows(step, extension)
        if own is None and engine == NATIVE:
            problem_is = "takes rows only; an extension that is more needs engine = 'cvxpy'"
            raise BackendError(problem_is, field="engine", value=engine)
        if own is None:
            return extended_solution(step, extension, backend, accuracy, certify)
        step = with_rows(step, own)
    if step.cone == ELLIPSOID:
        cone_backend(backend, "the ellipsoid")
    if isinstance(problem, SparseProblem) and certify != "full" and problem.fits(step):
        return problem.solution(step, accuracy, certify)
    if backend == NONE and certify != "full":
        raise BackendError("gives no answer of its own; use certify = 'full'", value=backend)
    if engine == NATIVE:
        problem = _native(step, backend, problem)
    solution = QUIET.copy().run(_solved, step, backend, accuracy, certify, problem)
    if solution is None:
        raise out_of_range(step)
    return solution


def _solved(
    step: StepData, backend: str, accuracy: float, certify: str, problem: Problem | None
) -> StepSolution | None:
    """The solution, or None if it is not finite."""
    kept = problem.metric if isinstance(problem, NativeProblem) else None
    question = _Question(Scaled(step, kept), backend, accuracy, problem)
    if certify != "full":
        solution = _believed(question, certify)
    else:
        solution = _enclosed(question) if step.cone == ELLIPSOID else _exact(question)
    good = finite(solution.delta_q) and finite(solution.lam)
    if certify != "off" or solution.lam_extra.size:
        residuals = np.array(list(solution.certificate.residuals.values()))
        others = (solution.lam_extra, solution.wrench.ravel(), residuals)
        good = good and all(map(finite, others))
    return solution if good else None


def _native(step: StepData, backend: str, problem: Problem | None) -> NativeProblem | None:
    """The caller's native problem if it fits, or another; None where no backend is asked."""
    if isinstance(problem, NativeProblem) and problem.backend == backend and problem.fits(step):
        return problem
    check_native(backend, step.cone)
    return None if backend == NONE else NativeProblem(step, backend)


@dataclass(eq=False)
class _Question:
    """A step, and who is asked for its answer, at which accuracy in natural units."""

    scaled: Scaled
    backend: str
    accuracy: float
    problem: Problem | None

    @property
    def step(self) -> StepData:
        return self.scaled.step

    def answer(self) -> Answer:
        """The backend's answer in natural units, the rows out of reach bearing no load."""
        if isinstance(self.problem, NativeProblem):
            return self.problem.answer(self.scaled, self.accuracy)
        natural = self.scaled.natural
        kept = self.problem if isinstance(self.problem, StepProblem) else None
        answer = backend_answer(within_reach(natural), self.backend, self.accuracy, kept)
        idle = np.repeat(out_of_reach(natural), natural.counts)
        answer.lam[: idle.size][idle] = 0.0  # the judge, who sees the true gap, decides
        return answer


def _believed(question: _Question, certify: str) -> StepSolution:
    """The backend's own answer."""
    step, units = question.step, question.scaled.units
    try:
        answer = question.answer()
        certificate = NOTHING_CLAIMED if certify == "off" else _judged(question, answer)
    except StepNotSolved as failure:
        failure.step = step  # the caller's own step, not its scaled copy
        raise
    delta_q, lam = from_natural(answer.delta_q, answer.lam, units)
    return _solution(step, delta_q, lam, question.backend, certificate, answer.statistics)


def _exact(question: _Question) -> StepSolution:
    """The exact optimum; a backend that fails costs its warm start, not the answer."""
    step, scaled = question.step, question.scaled
    answer, statistics = _attempt(question)
    warm: list[int] = []
    if answer is not None:
        form = standard_form(scaled.natural)
        warm = warm_rows(form.A, answer.lam, form.A @ answer.delta_q - form.b)
    optimum = exact_step(step, warm)
    if answer is not None:
        statistics = _graded(step, scaled.units, answer, optimum.delta_q, optimum.net)
    residuals = _natural_residuals(scaled, optimum.delta_q, optimum.lam)
    certificate = exact_certificate(step, optimum, residuals)
    return _solution(step, optimum.delta_q, optimum.lam, question.backend, certificate, statistics)


def _enclosed(question: _Question) -> StepSolution:
    """The optimum in the ellipsoid with a proved bound; where there is none, a judged answer."""
    step, units, name = question.step, question.scaled.units, question.backend
    answer, statistics = _attempt(question)
    found = enclosure(step)
    if found is None:
        if answer is None:
            status = f"{statistics.status}; and no answer strictly inside of all cones was found"
            raise StepNotSolved(name, status, step, question.accuracy)
        certificate = _judged(question, answer)
        delta_q, lam = from_natural(answer.delta_q, answer.lam, units)
        return _solution(step, delta_q, lam, name, certificate, statistics)
    length = relative_length(step, found.delta_q)
    if not length <= ILL_POSED:
        raise StepIllPosed(step, found.delta_q, length)
    if answer is not None:
        statistics = _graded(step, units, answer, found.delta_q, found.net)
    residuals = _natural_residuals(question.scaled, found.delta_q, found.lam)
    certificate = enclosure_certificate(step, found, residuals)
    return _solution(step, found.delta_q, found.lam, name, certificate, statistics)


def _attempt(question: _Question) -> tuple[Answer | None, SolverStatistics]:
    """A backend's answer, or None and why not."""
    statistics = SolverStatistics(question.backend, "not asked", None, None, question.accuracy)
    if question.backend == NONE:
        return None, statistics
    try:
        answer = question.answer()
    except StepNotSolved as failure:
        return None, statistics._replace(status=f"failed: {failure.status}", digits=0.0)
    return answer, answer.statistics


def _graded(
    step: StepData, units: Units, answer: Answer, delta_q: Array, net: Array
) -> SolverStatistics:
    """The statistics of a backend with the correct digits of its answer."""
    said, lam_said = from_natural(answer.delta_q, answer.lam, units)
    digits = correct_digits(step, said, delta_q, lam_said, net)
    return answer.statistics._replace(digits=digits.delta_q)


def _natural_residuals(scaled: Scaled, delta_q: Array, lam: Array) -> dict[str, float]:
    units = scaled.units
    x = delta_q / (units.size * units.coordinate)
    return asdict(_residuals(scaled.natural, x, lam * (units.length / units.size)))


def _residuals(step: StepData, delta_q: Array, lam: Array) -> Residuals:
    judge = ellipsoid_residuals if step.cone == ELLIPSOID else optimality_residuals
    return judge(step, delta_q, lam)


def _judged(question: _Question, answer: Answer) -> Certificate:
    """The backend's answer judged by its residuals."""
    natural = question.scaled.natural
    residuals = _residuals(natural, answer.delta_q, answer.lam)
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {answer.statistics.status}, but its worst residual is {worst}"
        raise StepNotSolved(question.backend, status, natural, question.accuracy, residuals)
    bound = error_bound(natural, answer.delta_q, answer.lam).error
    known = bound if math.isfinite(bound) else None
    return Certificate("residual", asdict(residuals), error_bound=known)


def _solution(
    step: StepData,
    delta_q: Array,
    lam: Array,
    backend: str,
    certificate: Certificate,
    statistics: SolverStatistics,
) -> StepSolution:
    m = int(step.offsets[-1])
    return StepSolution(
        delta_q=delta_q,
        lam=lam[:m],
        lam_extra=lam[m:],
        wrench=contact_wrenches(step.contacts, lam[:m], step.h, step.cone),
        backend=backend,
        certificate=certificate,
        statistics=statistics,
        cone=step.cone,
    )
