"""The verification of a certificate without any solver.

No step calls :func:`verify` or :func:`verify_answer`, which are for whoever wants to check an
answer afterwards.

A certificate names a working set of independent rows. Solving one linear system without rounding
gives the minimiser on it; if its multipliers are > 0 and its slacks >= 0, it is the optimum, which
is unique. Verification solves that system in rational numbers. It shares with the method that found
the answer the formation of H, g, A and b, the rational solution of that system, the test that H is
positive definite, and the decisions on degeneracy; it does not search for a working set.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Protocol, runtime_checkable

import numpy as np
from flint import arb
from numpy.typing import ArrayLike

from quasistatic_ref.certify.curved_cone import curved_cone
from quasistatic_ref.certify.degeneracy import Degeneracy, degeneracy, joined_degeneracy
from quasistatic_ref.certify.groups import flat_rows, group_steps, row_owners
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, ExactProgram, rounded_quotients
from quasistatic_ref.exact.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.exact.working_set import KktPoint, fraction_point
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.numbers.precision import nearest, working_precision
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.friction import impulses, wrenches
from quasistatic_ref.step.solution import Certificate, StepSolution


@runtime_checkable
class HasVerdict(Protocol):
    """An answer of another kind that can check itself: of a file, or of ``exact_qp``."""

    def verdict(self) -> Verdict:
        """Whether all claims of the answer hold."""


def verify(solution: StepSolution | HasVerdict) -> Verdict:
    """Whether all that a solution claims is so, checked without a solver.

    Its delta_q, multipliers and net impulse, and all fields of its certificate; of residuals, which
    are float64's, that they are numbers. The kinds ``"residual"`` and ``"none"``, which prove
    nothing, are refused, and so is a solution that is not of its step alone.

    Parameters
    ----------
    solution : StepSolution, SolutionFile, ExactQP or QPInfeasible
        A file's wrench is checked, too.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        As :func:`verify_answer`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> bool(qr.verify(qr.solve_step(step)))
    True
    """
    if not isinstance(solution, StepSolution):
        check_kind(solution, HasVerdict, "solution", "what solve_step or load_solution returns")
        return solution.verdict()
    claims = solution.certificate
    if not solution.alone:
        return Verdict(False, "costs or constraints that its step does not hold were solved, too")
    return verify_answer(
        solution.step,
        solution.delta_q,
        claims.active,
        solution.lam,
        claims,
        net_impulse=solution.net_impulse,
    )


def verify_answer(
    step: StepData,
    delta_q: ArrayLike,
    active: Sequence[tuple[int, int]],
    lam: ArrayLike | None = None,
    claims: Certificate | None = None,
    wrench: ArrayLike | None = None,
    net_impulse: ArrayLike | None = None,
) -> Verdict:
    """Whether delta_q is the exact optimum of a step, rounded correctly.

    Where a certificate claims less, as in the ellipsoid: whether that claim holds.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
        The claimed optimum; every bit counts.
    active : sequence of (int, int)
        Contact and row of each member of the working set, as in the certificate.
    lam : ndarray, shape (m,), optional
        The claimed multipliers on that working set, the user's own rows last.
    claims : Certificate, optional
        All fields but the residuals, which are float64's, are checked. One of another step is
        refused, and so are the kinds ``"residual"`` and ``"none"``, which prove nothing.
    wrench : ndarray, shape (n_c, 4), optional
        What lam is claimed to add up to, as a solution file has it [N, N m]; every bit counts.
    net_impulse : ndarray, shape (n_v,), optional
        The claimed A'lam [N s, N m s]; every bit counts, of an enclosure as far as that is proved.

    Returns
    -------
    Verdict

    Raises
    ------
    StepDataError
        If delta_q, lam, the wrench or the net impulse are no numbers.
    InputError
        If the wrench is given without lam, an argument is of another kind, or nothing can be proved
        in this thread: see :mod:`~quasistatic_ref.numbers.precision`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> solution = qr.solve_step(step)
    >>> bool(qr.verify_answer(step, solution.delta_q, solution.certificate.active))
    True
    """
    check_step(step)
    check_kind(active, Iterable, "active", "a list of (contact, row)")
    check_kind(claims, Certificate | None, "claims", "a Certificate")
    if claims is not None and claims.kind != "none" and not claims.is_of(step):
        return Verdict(False, "the certificate is of another step")
    delta_q = checked_numbers(delta_q, "delta_q")
    lam = None if lam is None else checked_numbers(lam, "lam")
    net = None if net_impulse is None else checked_numbers(net_impulse, "net_impulse")
    lengths = {
        "delta_q": (delta_q, step.n_v),
        "lam": (lam, step.m),
        "net_impulse": (net, step.n_v),
    }
    for name, (x, length) in lengths.items():
        if x is not None and np.shape(x) != (length,):
            return Verdict(False, f"{name} has shape {np.shape(x)}; the step wants ({length},)")
    problem = "" if wrench is None else _wrong_wrench(step, lam, wrench)
    problem = problem or ("" if claims is None else _wrong_residuals(claims))
    if problem:
        return Verdict(False, problem)
    if not cone(step.cone).polyhedral:
        return curved_cone(step).verdict(step, delta_q, active, lam, claims, net)
    if claims is not None and claims.kind != "exact":
        return Verdict(False, f"a certificate of kind {claims.kind!r} proves nothing here")
    try:
        working = flat_rows(step, active)
    except IndexError as error:
        return Verdict(False, str(error))
    except (TypeError, ValueError):
        problem = "must be a list of (contact, row)"
        raise InputError(problem, field="active", value=active) from None
    delta_q_exact = np.zeros(step.n_v)
    lam_exact = np.zeros(step.m)
    net_exact = np.zeros(step.n_v)
    reason = ""
    solved = []
    for group, part in group_steps(step):
        form = StepProgram(part)
        working_rows = group.within(working)
        try:
            exact = fraction_point(form, working_rows)
        except ZeroDivisionError:
            return Verdict(False, "the rows of the working set are not independent")
        with working_precision(EXACT):
            slack = form.slacks(range(form.m), exact.z)  # times the denominator
            times_h = exact.denominator * form.h
        delta_q_exact[group.coordinates] = rounded_quotients(exact.x, exact.denominator)
        lam_exact[group.rows[working_rows]] = rounded_quotients(exact.y, times_h)
        net_exact[group.coordinates] = rounded_quotients(exact.net.entries(), times_h)
        wrong = wrong_sign(form, working_rows, exact.y, slack)
        if wrong is not None and not reason:
            reason = _in_words(step, group.rows[wrong[0]], wrong[1])
        solved.append((form, working_rows, exact, slack))
    reason = reason or wrong_bits("delta_q", delta_q, delta_q_exact)
    if lam is not None and not reason:
        reason = wrong_bits("lam", lam, lam_exact)
    if net is not None and not reason:
        reason = wrong_bits("net_impulse", net, net_exact)
    if claims is not None and not reason:
        reason = _wrong_claim(solved, claims, lam_exact[list(working)])
    return Verdict(not reason, reason)


def rounded_wrenches(contacts: Contacts, lam: Array, h: float, name: str = PYRAMID) -> Array:
    """Contact wrenches, each number of them rounded once, as files have it.

    Parameters
    ----------
    contacts, lam, h, name
        As of :func:`~quasistatic_ref.step.friction.contact_wrenches`; lam is finite.

    Returns
    -------
    ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) [N, N m]: each the float64 nearest to the exact combination, which
        ``contact_wrenches`` may miss by the rounding of its sums; infinite beyond float64's range.
    """
    kind = cone(name)
    exact = np.frompyfunc(Fraction, 1, 1)
    of_rows = impulses(contacts, lam, name)
    mu = kind.row_coefficients(contacts.mu)
    wrench = wrenches(exact(of_rows), exact(kind.matrix), exact(mu)) / Fraction(h)
    rounded = [nearest(x.numerator, x.denominator) for x in wrench.ravel()]
    return np.reshape(rounded, (-1, 4)).astype(np.float64)


def _wrong_wrench(step: StepData, lam: Array | None, wrench: ArrayLike) -> str:
    """What is wrong with wrenches (n_c, 4) [N, N m] of multipliers (m,) [N s]; or empty."""
    if lam is None:
        raise InputError("is a combination of lam: give lam, too", field="wrench")
    if not np.isfinite(lam).all():
        return "lam is not finite"
    wrench = checked_numbers(wrench, "wrench")
    right = rounded_wrenches(step.contacts, lam[: step.offsets[-1]], step.h, step.cone)
    if np.shape(wrench)[:1] != right.shape[:1]:
        return f"wrench has shape {np.shape(wrench)}; the step wants {right.shape}"
    wrong = (wrong_bits(f"wrench[{j}]", wrench[j], row) for j, row in enumerate(right))
    return next(filter(None, wrong), "")


def _wrong_residuals(claims: Certificate) -> str:
    """What is wrong with residuals, which prove nothing, as numbers; or empty."""
    residuals = claims.residuals
    if isinstance(residuals, Mapping) and all(
        isinstance(value, float) and value >= 0 for value in residuals.values()
    ):
        return ""
    return "residuals are not numbers of at least 0 by name"


def wrong_sign(
    form: ExactProgram, working: Sequence[int], y: Sequence[arb], slack: Sequence[arb]
) -> tuple[int, str] | None:
    """The first row with a wrong sign at the minimiser on a working set, and which sign it is.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
    y, slack : sequence of arb
        Multipliers of the working set and all slacks, exact, times a positive number.

    Returns
    -------
    (int, str) or None
        The row, and ``"violated"``, ``"negative"`` or ``"zero"``: the last two of its multiplier.
    """
    for i, y_i in zip(working, y, strict=True):
        if i >= form.equations and y_i <= 0:
            return i, "negative" if y_i < 0 else "zero"
    for i, slack_i in enumerate(slack):
        if slack_i < 0 or (i < form.equations and slack_i > 0):
            return i, "violated"
    return None


def unique_and_smooth(
    form: ExactProgram, working: Sequence[int], slack: Sequence[arb]
) -> tuple[bool, bool]:
    """Whether multipliers are unique and x is differentiable, at a proved optimum.

    Parameters
    ----------
    form : ExactProgram
    working : sequence of int
    slack : sequence of arb
        All slacks, exact, times a positive number.
    """
    idle = [i for i, s in enumerate(slack) if s.is_zero() and i not in working]
    of_W = Minimiser(form, tuple(working)).implied(idle)
    return degeneracy(form, working, of_W, [i for i in idle if i not in of_W])


def _wrong_claim(
    solved: Sequence[tuple[ExactProgram, Sequence[int], KktPoint, Sequence[arb]]],
    claims: Certificate,
    lam_w: Array,
) -> str:
    """What is wrong with the claims, from each group's form, working set and solution."""
    of_groups = []
    for form, working, exact, slack in solved:
        unique, smooth = unique_and_smooth(form, working, slack)
        inactive = rounded_quotients((s for s in slack if not s.is_zero()), exact.denominator)
        least = min(inactive.tolist(), default=None) if smooth else 0.0
        of_groups.append(Degeneracy(unique, smooth, least))
    right = joined_degeneracy(of_groups)._asdict() | {
        "error_bound": 0.0,
        "gap": None,
        "smallest_active_multiplier": min(lam_w.tolist(), default=None),
    }
    wrong = (wrong_claim(name, getattr(claims, name), value) for name, value in right.items())
    return next(filter(None, wrong), "")


def _in_words(step: StepData, i: int, wrong: str) -> str:
    ((owner, (name,)),) = row_owners(step, [i]).items()
    row = f"row {name} of {owner}"
    if wrong == "violated":
        return f"{row} is violated by the minimiser on the working set"
    return f"the multiplier of {row} is {wrong}"
