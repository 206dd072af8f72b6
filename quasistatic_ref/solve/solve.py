"""One step, solved: a backend's reply, the exact optimum that it leads to, and a certificate.

A step of a run is proved, and mostly nobody asks how its rows touch, or how near its backend came:
what takes time is formed when it is read, from the step and its solution once more.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from quasistatic_ref.certify.curved_cone import Enclosed, curved_cone
from quasistatic_ref.certify.degeneracy import Degeneracy, step_degeneracy
from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.groups import contact_rows
from quasistatic_ref.certify.norm import check_length, correct_digits
from quasistatic_ref.certify.optimum import ExactOptimum, optimum_by_groups
from quasistatic_ref.certify.third_pairs import third_pair_rows
from quasistatic_ref.errors import StepDataError, keywords_named
from quasistatic_ref.exact.active_set import ROUNDED, basic_rows, warm_rows
from quasistatic_ref.numbers.arrays import Array, all_finite, positive_number, without_warnings
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.parts import part
from quasistatic_ref.solve.backends import Certify, check_certify, name_here
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import FREE, Reply, Solver
from quasistatic_ref.solve.units import in_natural, in_si, out_of_range
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.extension import StepExtension
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.standard_form import Units
from quasistatic_ref.text.plain import LazyFields
from quasistatic_ref.tolerances import ACCURACY, RESIDUAL_LIMIT

ExtendedSolution = Callable[
    [StepData, StepExtension, str | Callable[..., Any] | Solver | None, float, Certify],
    StepSolution,
]
"""The arguments of :func:`solve_step` -> the solution of a step with what a user adds."""
ROWS_AT_ONCE = 100
"""Most rows of which a start is chosen from all groups at once, and not from each. Where lam is not
unique, the start decides on it; that of small scenes is in committed runs."""
WITHIN_RANGE = 1e100
"""Far below the square root of float64's largest number."""
NOTHING_CLAIMED = Certificate("none")


@keywords_named
def solve_step(
    step: StepData,
    backend: str | Callable[..., Any] | Solver | None = None,
    *,
    accuracy: float = ACCURACY,
    certify: Certify = "full",
    extension: StepExtension | None = None,
) -> StepSolution:
    """The optimum of Eq. :eq:`eq-13`.

    Parameters
    ----------
    step : StepData
        SI units.
    backend : str, callable or Solver, optional
        A name from :func:`~quasistatic_ref.solve.backends.backend_names`, by default
        Clarabel's; ``"none"``, with ``certify="full"`` only, is the exact
        method from a cold start. Any other solver that CVXPY has installed, or qpsolvers behind
        ``qpsolvers:``. A function (P, q, G, h) -> (x, z, status). Or what
        :func:`~quasistatic_ref.solve.choice.solver_for` makes of these: an object that holds a
        compiled problem and is kept between steps of one kind. What is certified does not depend
        on it.
    accuracy : float
        Of the backend's answer, in natural units [-].
    certify : str
        ``"full"``: the exact optimum, correctly rounded, the same bits whatever the backend said
        (in the ellipsoid, whose optimum is in general not rational, enclosed to 1e-13 or better);
        ``"residual"``: the backend's answer, with its residuals, refused if these are not small;
        ``"off"``: the backend's answer, on its own word.
    extension : Extension, optional
        Constraints and costs of the caller's own. Linear constraints become rows of the step, and
        are certified as such; any others need a backend that takes cones, and get residuals.

    Returns
    -------
    StepSolution

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64, in which a backend is asked.
    StepInfeasible
        With ``"full"``, if no displacement satisfies the rows; with the proof.
    StepIllPosed
        With ``"full"``, if the exact optimum is more than 1e6 times longer than any step that its
        loads or its penetration ask for alone; see
        :func:`~quasistatic_ref.certify.norm.relative_length`.
    StepNotSolved
        With ``"residual"`` and ``"off"``, if the backend claims anything but a full solution; with
        ``"residual"`` also if the judge of residuals refuses its answer. With ``"full"`` only in
        the ellipsoid, if no enclosure is found and no answer of the backend passes the judge.
    BackendError
        If the backend is unknown or not installed, or does not support `certify` or the cone.
    InputError
        If a solver object does not fit the step, if `certify` is none of
        these words, if `accuracy` is not greater than 0, or, with ``"full"`` and ``"residual"``, if
        nothing can be proved in this thread: see :mod:`~quasistatic_ref.numbers.precision`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> bool((qr.solve_step(step).delta_q == qr.solve_step(step, "osqp").delta_q).all())
    True
    """
    check_step(step)
    accuracy = positive_number(accuracy, "accuracy")
    backend = name_here(backend)
    name = backend.name if isinstance(backend, Solver) else backend
    check_certify(name if isinstance(name, str) else None, certify)
    if extension is not None:
        extended_solution: ExtendedSolution = part("extended_solution")
        return extended_solution(step, extension, backend, accuracy, certify)
    if isinstance(backend, Solver):
        solver = backend
        solver.check(step)
    else:
        solver = solver_for(step, backend)
    return without_warnings(step_solution, NaturalStep(step), solver, accuracy, certify)


def step_solution(
    natural: NaturalStep,
    solver: Solver,
    accuracy: float,
    certify: Certify,
    start: Sequence[int] = (),
) -> StepSolution:
    """The optimum of a step that fits a solver, from arguments that are checked.

    It is called through :func:`~quasistatic_ref.numbers.arrays.without_warnings`.

    Parameters
    ----------
    natural : NaturalStep
    solver : Solver
    accuracy, certify
        As of :func:`solve_step`.
    start : sequence of int
        Rows from which the exact method starts where no backend replies.

    Raises
    ------
    StepNotSolved, StepInfeasible, StepIllPosed, StepDataError
        As of :func:`solve_step`.
    """
    if certify == "full" and not natural.step.m:
        reply = Reply(None, None, False, FREE, accuracy=accuracy, asked=False)
    else:
        reply = solver.reply(natural, accuracy)
    if certify == "full":
        solution = exact_solution(natural, solver, reply, start)
    elif reply.solved:
        solution = judged_solution(natural, solver, reply, certify)
    else:
        failure = StepNotSolved(solver.name, reply.status, natural.step, reply.accuracy)
        raise failure from reply.cause
    step = solution.step
    numbers = [solution.delta_q, solution.lam]
    checked = certify != "off" or step.extra.names
    if checked and not _surely_finite(step, solution.lam):
        numbers.append(solution.wrench.ravel())
    if not all(map(all_finite, numbers)):
        raise out_of_range()
    return solution


def _surely_finite(step: StepData, lam: Array) -> bool:
    """Whether bounds alone show that all wrenches of multipliers are finite: they are not formed.

    A wrench is a sum of multipliers, each times at most 1 and a coefficient of friction, over h.
    """
    most = math.sqrt(np.vdot(lam, lam)) * (1.0 + step.contacts.mu.max(initial=0.0))
    return bool(most < WITHIN_RANGE * step.h)


def statistics_of(solver: Solver, reply: Reply) -> SolverStatistics:
    """What a backend reports of its reply: status, iterations and time."""
    return SolverStatistics(
        solver.name,
        reply.status if reply.solved or not reply.asked else f"failed: {reply.status}",
        reply.iterations,
        reply.seconds,
        reply.accuracy,
        interface=solver.interface,
        unanswered=reply.asked and reply.x is None,
    )


def exact_solution(
    natural: NaturalStep, solver: Solver, reply: Reply, start: Sequence[int]
) -> StepSolution:
    """The proved optimum. The backend's reply, right or wrong, is only where its search starts.

    Without a reply the exact method (certify/optimum.py) starts elsewhere: the same optimum.
    In a curved cone, where no enclosure of the optimum is found, the reply is judged.

    Parameters
    ----------
    natural : NaturalStep
    solver : Solver
    reply : Reply
        Its reply, in natural units [-].
    start : sequence of int
        Rows from which the exact method starts where the backend claims no solution.

    Raises
    ------
    StepInfeasible, StepIllPosed
    StepNotSolved
        If no enclosure is found, and the backend has no answer that passes the judge.
    """
    step = natural.step
    statistics = statistics_of(solver, reply)
    claimed = reply if reply.solved else None
    begin = time.perf_counter()
    point = None if reply.x is None else in_si(*reply.point, natural.units)
    optimum: Enclosed | ExactOptimum | None
    if cone(step.cone).polyhedral:
        begins = starting_rows(natural, solver, claimed, start)
        optimum = optimum_by_groups(
            step, natural.groups, begins, solver.proofs, natural.own_inequalities
        )
    else:
        check_arithmetic()  # a backend may have changed it
        optimum = curved_cone(step).optimum(step, None if claimed is None else point)
        if optimum is None and claimed is not None:
            return judged_solution(natural, solver, claimed, "residual")
        if optimum is None:
            status = f"{statistics.status}; and no answer strictly inside of all cones was found"
            raise StepNotSolved(solver.name, status, step, statistics.accuracy)
    delta_q = optimum.delta_q
    lam = optimum.lam
    check_length(step, delta_q, natural.groups)
    if reply.asked:
        natural.check_range()
    if isinstance(optimum, ExactOptimum):
        units = natural.units if reply.asked else None
        certificate = exact_certificate(step, optimum, units)
    else:
        residuals = solution_residuals(step, natural.units, delta_q, lam)
        if not all(map(math.isfinite, residuals.values())):
            raise out_of_range()
        certificate = optimum.certificate(step, residuals)
    seconds = time.perf_counter() - begin
    if point is None:
        statistics = replace(statistics, proof_time=seconds)
    else:
        statistics = proof_statistics(statistics, seconds, step, point[0], delta_q)
    return StepSolution(delta_q, lam, step, certificate, statistics, optimum.net)


def starting_rows(
    natural: NaturalStep, solver: Solver, claimed: Reply | None, start: Sequence[int]
) -> list[list[int]]:
    """For each group, the rows from which the exact method starts.

    Parameters
    ----------
    natural : NaturalStep
    solver : Solver
    claimed : Reply or None
        What it claims to be a solution: the rows are those that it shows to be active.
    start : sequence of int
        Rows of the step from which to start without that.
    """
    groups = [group for group, _ in natural.groups]
    if claimed is None:
        return [group.within(start) for group in groups]
    x, y = claimed.point
    if solver.gives_basic_rows:
        moved = natural.units.coordinate * x
        y = y.copy()
        y[third_pair_rows(natural.step, natural.own_inequalities[0], moved, y)] = ROUNDED * y.max()
        return [basic_rows(y[group.rows]) for group in groups]
    if len(groups) > 1 and natural.step.m <= ROWS_AT_ONCE:
        form = natural.form
        rows = warm_rows(form.A, y, form.A @ x - form.b)
        return [group.within(rows) for group in groups]
    return [
        warm_rows(form.A, y[group.rows], form.A @ x[group.coordinates] - form.b)
        for group, form in zip(groups, natural.forms, strict=True)
    ]


def judged_solution(
    natural: NaturalStep, solver: Solver, reply: Reply, certify: Certify
) -> StepSolution:
    """A backend's reply as a solution in SI units, with its residuals as certificate.

    Parameters
    ----------
    natural : NaturalStep
    solver : Solver
    reply : Reply
        Its reply, in the natural units of `natural` [-].
    certify : str
        ``"residual"``: refused if its residuals are not small; ``"off"``: not looked at, with a
        certificate that claims nothing.

    Raises
    ------
    StepNotSolved
        If a residual is above ``RESIDUAL_LIMIT`` or not a number.
    """
    step = natural.step
    delta_q, lam = in_si(*reply.point, natural.units)
    statistics = statistics_of(solver, reply)
    if certify == "off":
        return StepSolution(delta_q, lam, step, NOTHING_CLAIMED, statistics)
    begin = time.perf_counter()
    check_arithmetic()
    # SI units may have rounded the reply: subnormals.
    residuals = natural.residuals(*in_natural(delta_q, lam, natural.units))
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {reply.status}, but its worst residual is {worst}"
        raise StepNotSolved(solver.name, status, step, reply.accuracy, residuals)
    certificate = Certificate("residual", dict(vars(residuals)), step=step)
    statistics = replace(statistics, proof_time=time.perf_counter() - begin)
    return StepSolution(delta_q, lam, step, certificate, statistics)


class ExactCertificate(LazyFields, Certificate):
    """The certificate of an exact optimum; its other fields are computed when they are read.

    Attributes
    ----------
    working_set : tuple of int
        Rows of the step.
    units : Units or None
        Its natural units, where the backend was asked.
    delta_q, lam : ndarray, shapes (n_v,) and (m,)
        The optimum [m, rad], [N s].
    """

    formed = (
        "active",
        "residuals",
        "multipliers_unique",
        "differentiable",
        "smallest_inactive_slack",
    )
    kept_instead = ("working_set", "units", "delta_q", "lam")
    working_set: tuple[int, ...]
    step: StepData
    units: Units | None
    delta_q: Array
    lam: Array

    @cached_property
    def active(self) -> tuple[tuple[int, int], ...]:
        """Contact and row of each member of the working set."""
        return contact_rows(self.step, self.working_set)

    @cached_property
    def residuals(self) -> dict[str, float]:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at the rounded optimum, in natural units [-].

        Raises
        ------
        StepDataError
            Of a step that was proved without a backend, if these leave the range of float64.
        """
        return without_warnings(solution_residuals, self.step, self.units, self.delta_q, self.lam)

    @cached_property
    def degeneracy(self) -> Degeneracy:
        """Whether multipliers are unique and delta_q is differentiable at the optimum."""
        return without_warnings(step_degeneracy, self.step, self.working_set)

    @property
    def multipliers_unique(self) -> bool:
        """Whether lam may be compared component by component."""
        return self.degeneracy.multipliers_unique

    @property
    def differentiable(self) -> bool:
        """Whether delta_q is differentiable with respect to the forces and targets (g)."""
        return self.degeneracy.differentiable

    @property
    def smallest_inactive_slack(self) -> float | None:
        """Smallest slack [m] of the rows that are not strictly active."""
        return self.degeneracy.smallest_inactive_slack


def exact_certificate(step: StepData, optimum: ExactOptimum, units: Units | None) -> Certificate:
    """The certificate of an exact optimum.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
        That of the step.
    units : Units or None
        Natural units of the step, where they are known.
    """
    certificate: Certificate = ExactCertificate.unchecked(
        kind="exact",
        working_set=optimum.working_set,
        smallest_active_multiplier=optimum.smallest_active_multiplier,
        error_bound=0.0,
        gap=None,
        step=step,
        units=units,
        delta_q=optimum.delta_q,
        lam=optimum.lam,
    )
    return certificate


class ProofStatistics(LazyFields, SolverStatistics):
    """The statistics of a solver whose reply can be compared with the optimum.

    Attributes
    ----------
    step : StepData
    reply, delta_q : ndarray, shape (n_v,)
        The solver's displacement and the optimum [m, rad].
    """

    formed = ("digits",)
    kept_instead = ("step", "reply", "delta_q")
    step: StepData
    reply: Array
    delta_q: Array

    @cached_property
    def digits(self) -> float:
        """Correct digits of the backend's delta_q, 0 to 16."""
        return without_warnings(correct_digits, self.step, self.reply, self.delta_q)


def proof_statistics(
    statistics: SolverStatistics, seconds: float, step: StepData, reply: Array, delta_q: Array
) -> SolverStatistics:
    """Statistics of a solver that gave a reply, with the time of the proof and the digits.

    Parameters
    ----------
    statistics : SolverStatistics
    seconds : float
        Wall time of the proof [s].
    step : StepData
    reply, delta_q : ndarray, shape (n_v,)
        Its displacement, and the optimum [m, rad].
    """
    fields = vars(statistics) | {"proof_time": seconds}
    del fields["digits"]
    complete: SolverStatistics = ProofStatistics.unchecked(
        **fields, step=step, reply=reply, delta_q=delta_q
    )
    return complete


def solution_residuals(
    step: StepData, units: Units | None, delta_q: Array, lam: Array
) -> dict[str, float]:
    """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at a solution [-], by name.

    None where float64 has no natural units for the step, which a proof does not need.

    Parameters
    ----------
    step : StepData
    units : Units or None
        Its natural units, where they are known.
    delta_q, lam : ndarray, shapes (n_v,) and (m,)
        [m, rad], [N s].
    """
    natural = NaturalStep(step, units)
    with suppress(StepDataError):
        if units is None:
            natural.check_range()
        return dict(vars(natural.residuals(*in_natural(delta_q, lam, natural.units))))
    return {}
