"""What is claimed about an exact answer, and its verification without any solver.

A certificate names a working set of independent rows. Solving one linear system without rounding
gives the minimiser on it; if its multipliers and slacks are >= 0 it is the optimum, which is
unique. Verification does that in rational numbers alone: it shares the formation of H, g, A, b
with the method that found the answer, not its balls, its walks or its proofs by primes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from flint import fmpq, fmpz

from quasistatic_ref.certify.balls import positive_definite
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.point import Rational, rational_solution
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rounding import nearest_fraction
from quasistatic_ref.certify.rows import ROW_NAMES, contact_rows, flat_rows
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import Certificate


@dataclass(frozen=True)
class Verdict:
    """Whether a certificate holds.

    Parameters
    ----------
    ok : bool
    reason : str
        Why not, in plain words; empty if it holds.
    """

    ok: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.ok


def exact_certificate(
    step: StepData, optimum: ExactOptimum, residuals: Mapping[str, float] | None = None
) -> Certificate:
    """The certificate of an exact optimum.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
        That of the step.
    residuals : mapping of str to float, optional
        Residuals of Eqs. (9)-(12) at the rounded answer, in natural units [-].

    Returns
    -------
    Certificate
    """
    return Certificate(
        kind="exact",
        residuals=dict(residuals or {}),
        active=contact_rows(step, optimum.working_set),
        multipliers_unique=optimum.multipliers_unique,
        differentiable=optimum.differentiable,
        smallest_inactive_slack=optimum.smallest_inactive_slack,
        smallest_active_multiplier=optimum.smallest_active_multiplier,
        error_bound=0.0,
    )


def verify(
    step: StepData,
    delta_q: Array,
    active: Sequence[tuple[int, int]],
    lam: Array | None = None,
) -> Verdict:
    """Whether delta_q is the exact optimum of a step, rounded correctly.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
        The claimed optimum; every bit counts, but for the sign of zero.
    active : sequence of (int, int)
        Contact and row of each member of the working set, as in the certificate.
    lam : ndarray, shape (m,), optional
        The claimed multipliers on that working set, the user's own rows last.

    Returns
    -------
    Verdict
    """
    form = exact_form(step)
    delta_q = np.asarray(delta_q, dtype=np.float64)
    if delta_q.shape != (form.n,):
        return Verdict(
            False, f"delta_q has shape {delta_q.shape}, the step has {form.n} coordinates"
        )
    try:
        working = flat_rows(step, active)
    except IndexError as error:
        return Verdict(False, str(error))
    if not positive_definite(form.H):
        return Verdict(False, "H is not positive definite")
    try:
        solution = rational_solution(form, working)
    except ZeroDivisionError:
        return Verdict(False, "the rows of the working set are not independent")
    reason = (
        _wrong_sign(step, working, solution)
        or _wrong_delta_q(form, solution, delta_q)
        or ("" if lam is None else _wrong_lam(form, working, solution, np.asarray(lam)))
    )
    return Verdict(not reason, reason)


def _wrong_sign(step: StepData, working: Sequence[int], solution: Rational) -> str:
    for i, lam_i in zip(working, solution.lam, strict=True):
        if lam_i < 0:
            return f"the multiplier of {_row_name(step, i)} is negative"
    for i, slack_i in enumerate(solution.slack):
        if slack_i < 0:
            return f"{_row_name(step, i)} is violated by the minimiser on the working set"
    return ""


def _wrong_delta_q(form: ExactForm, solution: Rational, delta_q: Array) -> str:
    for v, x_v in enumerate(solution.x):
        right = nearest_fraction(form.x_unit * fmpq(x_v, solution.denominator))
        if not delta_q[v] == right:
            given = float(delta_q[v])
            return f"delta_q[{v}] is {given!r}; the exact optimum rounds to {right!r}"
    return ""


def _wrong_lam(form: ExactForm, working: Sequence[int], solution: Rational, lam: Array) -> str:
    if lam.shape != (form.m,):
        return f"lam has shape {lam.shape}, the step has {form.m} rows"
    exact = dict(zip(working, solution.lam, strict=True))
    for i in range(form.m):
        right = nearest_fraction(form.lam_unit * fmpq(exact.get(i, fmpz(0)), solution.denominator))
        if not lam[i] == right:
            return f"lam[{i}] is {float(lam[i])!r}; on this working set it rounds to {right!r}"
    return ""


def _row_name(step: StepData, i: int) -> str:
    ((contact, row),) = contact_rows(step, [i])
    if contact == step.contacts.n_c:
        return f"the extra row {step.extra.names[row]}"
    return f"row {ROW_NAMES[row]} of contact {step.contacts.name[contact]}"
