"""What is claimed of an answer in the ellipsoid, and its verification without any solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from flint import ctx

from quasistatic_ref.certify.apex import apex_refutation
from quasistatic_ref.certify.enclosure import BITS, Enclosure, checked_pair, enclosed_error
from quasistatic_ref.certify.kkt import rational_solution, rounded_solution
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.certify.optimality import ellipsoid_residuals
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.certify.rows import contact_rows, flat_rows
from quasistatic_ref.certify.verdict import Verdict, wrong_bits
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import Certificate
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import IMPULSES


def enclosure_certificate(
    step: StepData, found: Enclosure, residuals: Mapping[str, float] | None = None
) -> Certificate:
    """The certificate of an answer in the ellipsoid.

    Parameters
    ----------
    step : StepData
    found : Enclosure
    residuals : mapping of str to float, optional
        Of Eqs. :eq:`eq-9`-:eq:`eq-12`, in natural units [-].

    Returns
    -------
    Certificate
        ``"exact"`` where every loaded contact is at its apex, ``"enclosure"`` otherwise.
    """
    exact = found.working_set is not None
    return Certificate(
        kind="exact" if exact else "enclosure",
        residuals=dict(residuals or {}),
        active=contact_rows(step, found.working_set or ()),
        error_bound=found.error,
    )


def ellipsoid_verdict(
    step: StepData,
    delta_q: Array,
    active: Sequence[tuple[int, int]],
    lam: Array | None,
    claims: Certificate | None,
) -> Verdict:
    """Whether an answer in the ellipsoid is what it is claimed to be.

    An exact one is checked in rational numbers, given lam. Of an enclosure, a feasible pair is
    found anew and checked in balls: delta_q must be within the claimed error of it.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    active : sequence of (int, int)
        Of an exact answer, the rows that it follows from.
    lam : ndarray, shape (m,), optional
    claims : Certificate, optional
        Without one, the answer counts as exact.

    Returns
    -------
    Verdict
    """
    kind = "exact" if claims is None else claims.kind
    claimed = 0.0 if claims is None or claims.error_bound is None else claims.error_bound
    if lam is None:
        return Verdict(False, "in the ellipsoid nothing is proved without lam")
    reason = _far_from_balance(step, delta_q, lam)
    if kind == "exact" and not reason:
        reason = _not_exact(step, delta_q, active, lam)
    elif kind == "enclosure" and not reason:
        form = exact_form(step)
        found = checked_pair(step)
        if found is None:
            return Verdict(False, "no displacement strictly inside of all cones was found")
        with ctx.workprec(BITS):
            error = enclosed_error(form, found, delta_q)
        if not error <= claimed:
            reason = f"error_bound is claimed to be {claimed!r}; {error!r} is proved"
    elif not reason:
        reason = f"a certificate of kind {kind!r} proves nothing"
    return Verdict(not reason, reason)


def _not_exact(
    step: StepData, delta_q: Array, active: Sequence[tuple[int, int]], lam: Array
) -> str:
    form = exact_form(step)
    try:
        working = flat_rows(step, active)
    except IndexError as error:
        return str(error)
    reason = apex_refutation(step, form, working, lam)
    if reason:
        return reason
    return wrong_bits(
        "delta_q", delta_q, rounded_solution(form, rational_solution(form, working))[0]
    )


def _far_from_balance(step: StepData, delta_q: Array, lam: Array) -> str:
    """Return what is wrong with lam: outside of its cone, or not what delta_q needs."""
    form = standard_form(step)
    if delta_q.shape != form.g.shape or lam.shape != form.b.shape:
        return "delta_q or lam has another shape than the step wants"
    norm = energy_norm(form.H)
    impulses = norm.impulses(np.stack([form.H @ delta_q - form.g - form.A.T @ lam, form.g]))
    largest = float(np.abs(lam).max(initial=0.0))
    if not impulses[0] <= IMPULSES * max(impulses[1], norm.displacement(delta_q)):
        return "lam does not balance the step"
    if not ellipsoid_residuals(step, delta_q, lam).dual <= IMPULSES * largest:
        return "lam is outside of its cone"
    return ""
