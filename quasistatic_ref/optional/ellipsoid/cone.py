r"""The ellipsoid, :math:`f_1^2/\mu_v^2 + f_2^2/\mu_v^2 + \tau^2/\mu_\omega^2 \le f_n^2`, as a cone.

What is claimed of an answer in it is verified here, without any solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.curved_cone import CurvedCone
from quasistatic_ref.certify.groups import contact_rows
from quasistatic_ref.certify.norm import error_length, norm_of, single_loads
from quasistatic_ref.certify.residuals import largest
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.program import ExactProgram, fraction, rounded_quotients
from quasistatic_ref.exact.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.numbers.arrays import Array, Mask, without_warnings
from quasistatic_ref.numbers.precision import nearest_fraction, working_precision
from quasistatic_ref.optional.ellipsoid.apex import apex
from quasistatic_ref.optional.ellipsoid.enclosure import (
    BITS,
    Enclosure,
    checked_pair,
    enclosed_error,
    enclosure,
    point,
)
from quasistatic_ref.optional.ellipsoid.forces import compliant_forces
from quasistatic_ref.optional.ellipsoid.gap import negligible, rounded_up
from quasistatic_ref.optional.ellipsoid.impulses import outside_of_cones, raised
from quasistatic_ref.optional.ellipsoid.tolerances import ENCLOSED, IMPULSES
from quasistatic_ref.optional.gap import duality_gap, fractions, rational
from quasistatic_ref.step.cones import ELLIPSOID, Claims, Judge, Rows, Violations
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import Certificate
from quasistatic_ref.step.standard_form import linear_term

if TYPE_CHECKING:
    import cvxpy as cp

Active = tuple[tuple[int, int], ...]
LARGEST = float(np.finfo(np.float64).max)
ROUNDED = 2.0**-51
"""Of an entry of A'lam: what rounding leaves of it."""
UNSTATED = Certificate("exact", error_bound=0.0)
"""What an answer without a certificate counts as."""


class EllipsoidCone(CurvedCone):
    """gap >= ||(slip_1, slip_2, spin)||: one second-order cone for each contact."""

    claims: ClassVar[Claims] = {
        "exact": ("active", "error_bound", "gap"),
        "enclosure": ("error_bound", "gap"),
        "residual": (),
        "none": (),
    }

    def row_coefficients(self, mu: Array) -> Array:
        """1, (n_c, 3): the rows of a contact are J_n, J_1, J_2 and J_w [-]; `mu` is the cone's."""
        return np.ones_like(mu)

    def constraints(self, motion: Rows, mask: Mask) -> list[cp.Constraint]:
        """All contacts in one second-order cone constraint; arguments as of the base [m]."""
        import cvxpy as cp  # it takes its time

        gap, *slips = motion
        return [cp.SOC(gap, cp.vstack(slips))] if gap.size else []

    def multipliers(self, constraints: Sequence[cp.Constraint], mask: Mask, mu: Array) -> Array:
        """Impulses (n, d1, d2, spin) of each contact, shape (4 n_c,) [N s, N m s]."""
        if not constraints:
            return np.zeros(0)
        f_n, scaled = constraints[0].dual_value
        return np.column_stack([f_n, mu * scaled.T]).ravel()

    def judge(self, mu: Array) -> Judge:
        """The judge of forces and motions of contacts, as of the base class, in this cone.

        (10) reads s_n >= ||mu o s_t||, (11) f_n >= ||f_t / mu|| and (12) f's = 0.

        Parameters
        ----------
        mu : ndarray, shape (n_c, 3)
            As of contacts [-, -, m].
        """
        return lambda slack, lam: cone_violations(mu, slack, lam)

    def optimum(self, step: StepData, start: tuple[Array, Array] | None) -> Enclosure | None:
        """The enclosure of the optimum; None where none can be certified.

        Parameters
        ----------
        step : StepData
        start : (ndarray, ndarray), optional
            A backend's delta_q and lam, shapes (n_v,) [m, rad] and (m,) [N s].
        """
        return enclosure(step, start)

    def in_words(self, certificate: Certificate) -> str:
        """What ``"exact"`` means here."""
        return "exact: the optimum of the step, correctly rounded; every loaded contact sticks"

    def forces(
        self, step: StepData, compliance: float, near: tuple[Array, Array]
    ) -> tuple[Array, Array]:
        """See :mod:`~quasistatic_ref.optional.ellipsoid.forces`; arguments as of the base.

        Parameters
        ----------
        step : StepData
        compliance : float
            [m/N].
        near : (ndarray, ndarray)
            Shapes (n_v,) [m, rad] and (n_c, 4) [N, N m].

        Returns
        -------
        (ndarray, ndarray)
            Forces, shape (n_c, 4) [N, N m], and delta_q, shape (n_v,) [m, rad].

        Raises
        ------
        StepNotSolved
            If no enclosure is found.
        """
        return compliant_forces(step, compliance, near)

    def verdict(
        self,
        step: StepData,
        delta_q: Array,
        active: Sequence[tuple[int, int]],
        lam: Array | None,
        claims: Certificate | None,
        net: Array | None = None,
    ) -> Verdict:
        """The verdict on an answer in the ellipsoid: whether all of its claims hold.

        delta_q of an exact answer is held against the rational optimum, bit for bit. Of an
        enclosure, a feasible pair is found again and checked in balls: delta_q must be within the
        claimed error of it. lam must be in its cones, and its duality gap no more than claimed;
        where none is claimed, both are held to rounding alone.

        Parameters
        ----------
        step : StepData
        delta_q : ndarray, shape (n_v,)
        active : sequence of (int, int)
            Of an exact answer: the first independent rows of the contacts that bear load.
        lam : ndarray, shape (m,), optional
        claims : Certificate, optional
            Without one, the answer counts as exact.
        net : ndarray, shape (n_v,), optional
            A'lam [N s, N m s]: of an exact answer to the last bit, of an enclosure as near as that.
        """
        claims = UNSTATED if claims is None else claims
        if claims.kind not in ("exact", "enclosure"):
            return Verdict(False, f"a certificate of kind {claims.kind!r} proves nothing")
        if lam is None:
            return Verdict(False, "in the ellipsoid nothing is proved without lam")
        form = StepProgram(step)
        if delta_q.shape != (form.n,) or lam.shape != (form.m,):
            return Verdict(False, "delta_q or lam has another shape than the step wants")
        if not (np.isfinite(delta_q).all() and np.isfinite(lam).all()):
            return Verdict(False, "delta_q or lam is not finite")
        judge = _not_exact if claims.kind == "exact" else _not_enclosed
        x, reason = judge(step, form, delta_q, tuple(active), lam, claims)
        reason = reason or _not_multipliers(step, form, x, lam, claims.gap)
        if net is not None and not reason:
            reason = _not_net(step, form, x, net, exact=claims.kind == "exact")
        return Verdict(not reason, reason)


def motion(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    """Gap, slips and spin [m] of a contact, which are its rows as they are."""
    return gap, slip_1, slip_2, spin


ELLIPSOID_CONE = EllipsoidCone(ELLIPSOID, ("n", "d1", "d2", "spin"), 4, motion)


def cone_violations(mu: Array, slack: Array, lam: Array) -> Violations:
    """How far each contact, then each row of the user's own, is from Eqs. :eq:`eq-10`-:eq:`eq-12`.

    Parameters
    ----------
    mu : ndarray, shape (n_c, 3)
        (mu_v, mu_v, mu_omega) [-, -, m].
    slack, lam : ndarray, shape (m,)
        Motion [m, rad] and impulse [N s, N m s] of each contact along (n, d1, d2, spin), then the
        slacks and multipliers of the user's own rows.
    """
    k = 4 * len(mu)
    s = slack[:k].reshape(-1, 4)
    f = lam[:k].reshape(-1, 4)
    extra_slack = slack[k:]
    extra_lam = lam[k:]
    scaled = np.divide(f[:, 1:], mu, out=np.zeros_like(mu), where=mu > 0)
    without = np.abs(np.where(mu > 0, 0.0, f[:, 1:]))  # a force that has no coefficient
    short = np.linalg.norm(mu * s[:, 1:], axis=1) - s[:, 0]  # Eq. (10)
    pull = np.linalg.norm(scaled, axis=1) - f[:, 0]  # Eq. (11)
    work = np.sum(s * f, axis=1)  # Eq. (12)
    return (
        np.concatenate([short, -extra_slack]),
        np.concatenate([pull, without.ravel(), -extra_lam]),
        np.concatenate([work, extra_slack * extra_lam]),
    )


def _not_exact(
    step: StepData,
    form: ExactProgram,
    delta_q: Array,
    active: Active,
    lam: Array,
    claims: Certificate,
) -> tuple[list[fmpq], str]:
    """The rational optimum [m, rad], and what is wrong with the claim of it."""
    rows, solution, refutation = apex(step, form, lam)
    reason = (
        refutation
        or wrong_bits("delta_q", delta_q, rounded_quotients(solution.x, solution.denominator))
        or wrong_claim("active", active, contact_rows(step, rows))
        or wrong_claim("error_bound", claims.error_bound, 0.0)
    )
    return solution.exact_x, reason


def _not_enclosed(
    step: StepData,
    form: ExactProgram,
    delta_q: Array,
    active: Active,
    lam: Array,
    claims: Certificate,
) -> tuple[list[fmpq], str]:
    """A point next to the optimum [m, rad], and what is wrong with the claim."""
    pair = checked_pair(step)
    if pair is None:
        return [], "no displacement strictly inside of all cones was found"
    with working_precision(BITS):
        error = enclosed_error(form, pair, delta_q)
        claimed = claims.error_bound
    reason = wrong_claim("active", active, ())
    if claimed is None or not error <= claimed:
        reason = f"error_bound is claimed to be {claimed!r}; {error!r} is proved"
    elif not claimed <= ENCLOSED:
        reason = f"error_bound is {claimed!r}; an enclosure has {ENCLOSED!r} at most"
    return point(pair), reason


def _not_net(
    step: StepData, form: ExactProgram, x: Sequence[fmpq], net: Array, *, exact: bool
) -> str:
    """What is wrong with A'lam = H x - g, at the optimum x or next to it; or empty."""
    pull = rational(form.H) * fmpq_mat(form.n, 1, [*x]) - rational(form.g)
    numbers = [v / fraction(form.h) for v in pull.entries()]
    right = np.array([nearest_fraction(v) for v in numbers], dtype=np.float64)
    if exact:
        return wrong_bits("net_impulse", net, right)
    off = np.maximum(np.abs(net - right) - ROUNDED * np.abs(right), 0.0)
    moved = np.array([float(v) for v in x])
    allowed = ENCLOSED * error_length(step.H, linear_term(step), moved, single_loads(step))
    near = without_warnings(norm_of(step).of_impulse, off) <= allowed  # not: NaN
    return "" if near else "net_impulse is not A'lam"


def _not_multipliers(
    step: StepData, form: ExactProgram, x: Sequence[fmpq], lam: Array, claimed: float | None
) -> str:
    """Why lam is no multiplier at x: outside of its cones, or not in balance; or empty."""
    if claimed is None:
        _, pull, _ = cone_violations(step.contacts.mu, np.zeros(form.m), lam)
        allowed = IMPULSES * float(np.abs(lam).max(initial=0.0))
        outside = "" if largest(pull) <= allowed else "its cone"
        lam = raised(step, lam)
    else:
        outside = outside_of_cones(step, fractions(lam))
    if outside:
        return f"lam is outside of its cone at {outside}"
    gap = duality_gap(form, x, fractions(lam))
    if not negligible(form, x, gap):
        return (
            "lam does not hold the step: it does not balance it, or presses where nothing touches"
        )
    if claimed is None:
        return ""
    if not (proved := rounded_up(gap)) <= claimed:
        return f"gap is claimed to be {claimed!r}; {proved!r} is proved"
    if not negligible(form, x, fraction(min(claimed, LARGEST))):
        return f"gap is {claimed!r}, which is more than rounding"
    return ""
