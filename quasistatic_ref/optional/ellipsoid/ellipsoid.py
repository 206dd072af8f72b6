"""What is claimed of an answer in the ellipsoid, and its verification without any solver."""

from collections.abc import Mapping, Sequence

import numpy as np
from flint import ctx, fmpq

from quasistatic_ref.certify.gap import duality_gap, fractions, in_joules, negligible
from quasistatic_ref.certify.kkt import rational_solution, rounded_solution
from quasistatic_ref.certify.optimality import ellipsoid_residuals
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rows import contact_rows
from quasistatic_ref.certify.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.optional.ellipsoid.apex import apex_refutation, apex_rows
from quasistatic_ref.optional.ellipsoid.enclosure import (
    BITS,
    Enclosure,
    checked_pair,
    enclosed_error,
    point,
)
from quasistatic_ref.optional.ellipsoid.impulses import outside_of_cones, raised
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import Certificate
from quasistatic_ref.tolerances import ENCLOSED, IMPULSES

Active = tuple[tuple[int, int], ...]
LARGEST = float(np.finfo(np.float64).max)
UNSTATED = Certificate("exact", error_bound=0.0)
"""What an answer without a certificate counts as."""


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
        gap=found.gap,
        step=step,
    )


def ellipsoid_verdict(
    step: StepData,
    delta_q: Array,
    active: Sequence[tuple[int, int]],
    lam: Array | None,
    claims: Certificate | None,
) -> Verdict:
    """Whether an answer in the ellipsoid is what it is claimed to be.

    delta_q of an exact answer is held against the rational optimum, bit for bit. Of an enclosure, a
    feasible pair is found again and checked in balls: delta_q must be within the claimed error of
    it. lam must be in its cones, and its duality gap no more than claimed; where none is
    claimed, both are held to rounding alone.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    active : sequence of (int, int)
        Of an exact answer: the first independent rows of the contacts that bear load.
    lam : ndarray, shape (m,), optional
    claims : Certificate, optional
        Without one, the answer counts as exact.

    Returns
    -------
    Verdict
    """
    claims = UNSTATED if claims is None else claims
    if claims.kind not in ("exact", "enclosure"):
        return Verdict(False, f"a certificate of kind {claims.kind!r} proves nothing")
    if lam is None:
        return Verdict(False, "in the ellipsoid nothing is proved without lam")
    form = exact_form(step)
    if delta_q.shape != (form.n,) or lam.shape != (form.m,):
        return Verdict(False, "delta_q or lam has another shape than the step wants")
    if not (np.isfinite(delta_q).all() and np.isfinite(lam).all()):
        return Verdict(False, "delta_q or lam is not finite")
    judge = _not_exact if claims.kind == "exact" else _not_enclosed
    x, reason = judge(step, form, delta_q, tuple(active), lam, claims)
    reason = reason or _not_multipliers(step, form, x, lam, claims.gap)
    return Verdict(not reason, reason)


def _not_exact(
    step: StepData, form: ExactForm, delta_q: Array, active: Active, lam: Array, claims: Certificate
) -> tuple[list[fmpq], str]:
    """Return the rational optimum in the form's units, and what is wrong with the claim of it."""
    working = apex_rows(step, form, lam)
    reason = apex_refutation(step, form, working, lam) or ""
    if reason:
        return [], reason
    solution = rational_solution(form, working)
    reason = (
        wrong_bits("delta_q", delta_q, rounded_solution(form, solution)[0])
        or wrong_claim("active", active, contact_rows(step, working))
        or wrong_claim("error_bound", claims.error_bound, 0.0)
    )
    return [fmpq(v) / solution.denominator for v in solution.x], reason


def _not_enclosed(
    step: StepData, form: ExactForm, delta_q: Array, active: Active, lam: Array, claims: Certificate
) -> tuple[list[fmpq], str]:
    """Return a point next to the optimum in the form's units, and what is wrong with the claim."""
    found = checked_pair(step)
    if found is None:
        return [], "no displacement strictly inside of all cones was found"
    with ctx.workprec(BITS):
        error, claimed = enclosed_error(form, found, delta_q), claims.error_bound
    reason = wrong_claim("active", active, ())
    if claimed is None or not error <= claimed:
        reason = f"error_bound is claimed to be {claimed!r}; {error!r} is proved"
    elif not claimed <= ENCLOSED:
        reason = f"error_bound is {claimed!r}; an enclosure has {ENCLOSED!r} at most"
    return point(found), reason


def _not_multipliers(
    step: StepData, form: ExactForm, x: Sequence[fmpq], lam: Array, claimed: float | None
) -> str:
    """Return what is wrong with lam: outside of its cones, or not what holds x."""
    if claimed is None:
        dual = ellipsoid_residuals(step, np.zeros(form.n), lam).dual
        outside = "its cone" if not dual <= IMPULSES * float(np.abs(lam).max(initial=0.0)) else ""
        lam = raised(step, lam)
    else:
        outside = outside_of_cones(step, fractions(lam, form.lam_unit))
    if outside:
        return f"lam is outside of its cone at {outside}"
    gap = duality_gap(form, x, fractions(lam, form.lam_unit))
    if not negligible(form, x, gap):
        return (
            "lam does not hold the step: it does not balance it, or presses where nothing touches"
        )
    if claimed is None:
        return ""
    if not (proved := in_joules(form, gap)) <= claimed:
        return f"gap is claimed to be {claimed!r}; {proved!r} is proved"
    stated = fractions(np.array([min(claimed, LARGEST)]), form.net_unit * form.x_unit)
    if not negligible(form, x, *stated):
        return f"gap is {claimed!r}, which is more than rounding"
    return ""
