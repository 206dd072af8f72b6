"""One step, solved: natural units, a backend, the judge, and back to SI units."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

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
    StepDataError,
    StepIllPosed,
    StepNotSolved,
)
from quasistatic_ref.solve.ask import Answer, backend_answer
from quasistatic_ref.solve.backends import DEFAULT, NONE, cone_backend
from quasistatic_ref.solve.extended import extended_solution, extension_rows, with_rows
from quasistatic_ref.solve.units import (
    Units,
    from_natural,
    natural_units,
    out_of_reach,
    to_natural,
    within_reach,
)
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.problem import StepProblem
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY, ILL_POSED, RESIDUAL_LIMIT

CERTIFY = ("full", "residual", "off")


def solve_step(
    step: StepData,
    backend: str = DEFAULT,
    *,
    accuracy: float = ACCURACY,
    certify: str = "full",
    problem: StepProblem | None = None,
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
    accuracy : float
        Asked of the backend, in natural units [-].
    certify : str
        ``"full"``: the exact optimum, correctly rounded, the same bits whatever the backend said
        (in the ellipsoid, which has no rational optimum, enclosed to 1e-13 or better);
        ``"residual"``: the backend's answer, refused if its residuals are not small, with a
        rigorous bound of its error; ``"off"``: the backend's answer, on its own word.
    problem : StepProblem, optional
        A compiled problem of the same kind, kept by the caller between steps.
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
        If the backend is unknown or not installed.
    InputError
        If `certify` is no such word, or `accuracy` not greater than 0.
    """
    if not accuracy > 0:
        raise InputError("must be greater than 0", field="accuracy", value=accuracy)
    if certify not in CERTIFY:
        raise InputError(f"must be one of {', '.join(CERTIFY)}", field="certify", value=certify)
    if extension is not None:
        own = extension_rows(step, extension)
        if own is None:
            return extended_solution(step, extension, backend, accuracy, certify)
        step = with_rows(step, own)
    if step.cone == ELLIPSOID:
        cone_backend(backend, "the ellipsoid")
    if backend == NONE and certify != "full":
        raise BackendError("gives no answer of its own; use certify = 'full'", value=backend)
    # What overflows shows in the result; the processor's flags, which NumPy warns of, get lost
    # between BLAS's threads.
    with np.errstate(all="ignore"):
        natural, units = _scaled(step)
        if certify == "full":
            road = _enclosed if step.cone == ELLIPSOID else _exact
            solution = road(step, natural, units, backend, accuracy, problem)
        else:
            solution = _believed(step, natural, units, backend, accuracy, certify, problem)
    numbers = (solution.delta_q, solution.lam, solution.lam_extra, solution.wrench.ravel())
    residuals = np.array(list(solution.certificate.residuals.values()))
    if not np.isfinite(np.concatenate([*numbers, residuals])).all():
        raise _out_of_range()
    return solution


def _scaled(step: StepData) -> tuple[StepData, Units]:
    """The step in its natural units."""
    try:
        units = natural_units(step)
        sizes = np.array([*units.coordinate, units.length, units.size])
        if (np.isfinite(sizes) & (sizes > 0)).all():
            return to_natural(step, units), units
    except (StepDataError, np.linalg.LinAlgError):
        pass
    raise _out_of_range()


def _out_of_range() -> StepDataError:
    return StepDataError(
        "its numbers are too large, too small or too unlike each other: their products leave the "
        "range of float64; look for a wrong unit"
    )


def _believed(
    step: StepData,
    natural: StepData,
    units: Units,
    backend: str,
    accuracy: float,
    certify: str,
    problem: StepProblem | None,
) -> StepSolution:
    """The backend's own answer."""
    try:
        answer = _asked(natural, backend, accuracy, problem)
        certificate = _judged(natural, answer, backend, accuracy, certify)
    except StepNotSolved as failure:
        failure.step = step  # the caller's own step, not its scaled copy
        raise
    delta_q, lam = from_natural(answer.delta_q, answer.lam, units)
    return _solution(step, delta_q, lam, backend, certificate, answer.statistics)


def _asked(natural: StepData, backend: str, accuracy: float, problem: StepProblem | None) -> Answer:
    """The backend's answer, the rows out of reach bearing no load."""
    answer = backend_answer(within_reach(natural), backend, accuracy, problem)
    idle = np.repeat(out_of_reach(natural), natural.counts)
    answer.lam[: idle.size][idle] = 0.0  # the judge, who sees the true gap, decides
    return answer


def _exact(
    step: StepData,
    natural: StepData,
    units: Units,
    backend: str,
    accuracy: float,
    problem: StepProblem | None,
) -> StepSolution:
    """The exact optimum; a backend that fails costs its warm start, not the answer."""
    answer, statistics = _attempt(natural, backend, accuracy, problem)
    warm: list[int] = []
    if answer is not None:
        form = standard_form(natural)
        warm = warm_rows(form.A, answer.lam, form.A @ answer.delta_q - form.b)
    optimum = exact_step(step, warm)
    if answer is not None:
        statistics = _graded(step, units, answer, optimum.delta_q, optimum.net)
    residuals = _natural_residuals(natural, units, optimum.delta_q, optimum.lam)
    certificate = exact_certificate(step, optimum, residuals)
    return _solution(step, optimum.delta_q, optimum.lam, backend, certificate, statistics)


def _enclosed(
    step: StepData,
    natural: StepData,
    units: Units,
    backend: str,
    accuracy: float,
    problem: StepProblem | None,
) -> StepSolution:
    """The optimum in the ellipsoid with a proved bound; where there is none, a judged answer."""
    answer, statistics = _attempt(natural, backend, accuracy, problem)
    found = enclosure(step)
    if found is None:
        if answer is None:
            status = f"{statistics.status}; and no answer strictly inside of all cones was found"
            raise StepNotSolved(backend, status, step, accuracy)
        certificate = _judged(natural, answer, backend, accuracy, "residual")
        delta_q, lam = from_natural(answer.delta_q, answer.lam, units)
        return _solution(step, delta_q, lam, backend, certificate, statistics)
    length = relative_length(step, found.delta_q)
    if not length <= ILL_POSED:
        raise StepIllPosed(step, found.delta_q, length)
    if answer is not None:
        statistics = _graded(step, units, answer, found.delta_q, found.net)
    residuals = _natural_residuals(natural, units, found.delta_q, found.lam)
    certificate = enclosure_certificate(step, found, residuals)
    return _solution(step, found.delta_q, found.lam, backend, certificate, statistics)


def _attempt(
    natural: StepData, backend: str, accuracy: float, problem: StepProblem | None
) -> tuple[Answer | None, SolverStatistics]:
    """A backend's answer, or None and why not."""
    statistics = SolverStatistics(backend, "not asked", None, None, accuracy)
    if backend == NONE:
        return None, statistics
    try:
        answer = _asked(natural, backend, accuracy, problem)
    except StepNotSolved as failure:
        return None, replace(statistics, status=f"failed: {failure.status}", digits=0.0)
    return answer, answer.statistics


def _graded(
    step: StepData, units: Units, answer: Answer, delta_q: Array, net: Array
) -> SolverStatistics:
    """The statistics of a backend with the correct digits of its answer."""
    said, lam_said = from_natural(answer.delta_q, answer.lam, units)
    digits = correct_digits(step, said, delta_q, lam_said, net)
    return replace(answer.statistics, digits=digits.delta_q)


def _natural_residuals(
    natural: StepData, units: Units, delta_q: Array, lam: Array
) -> dict[str, float]:
    x = delta_q / (units.size * units.coordinate)
    return asdict(_residuals(natural, x, lam * (units.length / units.size)))


def _residuals(step: StepData, delta_q: Array, lam: Array) -> Residuals:
    judge = ellipsoid_residuals if step.cone == ELLIPSOID else optimality_residuals
    return judge(step, delta_q, lam)


def _judged(
    natural: StepData, answer: Answer, name: str, accuracy: float, certify: str
) -> Certificate:
    """The backend's answer judged by its residuals, or not at all."""
    if certify == "off":
        return Certificate("none")
    residuals = _residuals(natural, answer.delta_q, answer.lam)
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {answer.statistics.status}, but its worst residual is {worst}"
        raise StepNotSolved(name, status, natural, accuracy, residuals)
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
