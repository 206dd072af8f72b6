"""What is claimed about an answer, and the verification of that claim without any solver.

The exact method states its result as a :class:`Certificate`. No step calls :func:`verify`, which is
for whoever wants to check an answer afterwards.

A certificate names a working set of independent rows. Solving one linear system without rounding
gives the minimiser on it; if its multipliers are > 0 and its slacks >= 0, it is the optimum, which
is unique. Verification solves that system in rational numbers. It shares with the method that found
the answer the formation of H, g, A and b, the rational solution of that system, the test that H is
positive definite, and the decisions on degeneracy; it does not search for a working set.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from flint import arb, ctx

from quasistatic_ref.certify.degeneracy import degeneracy
from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.form import EXACT, ExactForm, StepForm
from quasistatic_ref.certify.minimiser import (
    Solution,
    fraction_solution,
    implied_rows,
    rounded_quotients,
)
from quasistatic_ref.certify.rows import contact_rows, flat_rows, row_owners
from quasistatic_ref.certify.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import HasPage
from quasistatic_ref.parts import needing
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.files import step_sha256
from quasistatic_ref.step.groups import Group, groups


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Plain, HasPage):
    """What is known about an answer, and how.

    Parameters
    ----------
    kind : str
        ``"exact"`` (delta_q is the exact optimum, correctly rounded), ``"enclosure"`` (in the
        ellipsoid: delta_q is proved to be as near to the optimum as error_bound says),
        ``"residual"`` (optimality residuals were computed and are small) or ``"none"``.
    residuals : mapping of str to float
        Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` in natural units [-]. They differ in the last
        places from processor to processor, prove nothing, and never enter a solution file.
    active : tuple of (int, int)
        Contact and row of each member of the working set; the user's own rows count as those of
        one contact more. The rows of the working set are independent, their multipliers positive
        and their slacks zero. In the ellipsoid, for ``"exact"``: the first independent rows of the
        contacts that bear load.
    multipliers_unique : bool or None
        Whether lam may be compared component by component. Here and below None: nothing is claimed.
    differentiable : bool or None
        Whether delta_q is differentiable with respect to the forces and targets (g).
    smallest_inactive_slack : float or None
        Smallest slack [m] of the rows that are not strictly active: 0.0 where delta_q is not
        differentiable. None if there are no such rows.
    smallest_active_multiplier : float or None
        Smallest multiplier [N s] of the working set. None if that is empty.
    error_bound : float or None
        Bound of ||delta_q - delta_q*||_H / ||H^-1 g||_H [-]; 0.0 for ``"exact"``, where the only
        error is the correct rounding of each entry.
    gap : float or None
        The duality gap of lam in the ellipsoid, no distance: a bound of f(delta_q*) - d(lam)
        [N m s].
    step : StepData or None
        What it is about. Only kind ``"none"``, which claims nothing, is about no step.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.solve_step(step).certificate.kind
    'exact'
    """

    kind: str
    residuals: Mapping[str, float] = field(default_factory=dict)
    active: tuple[tuple[int, int], ...] = ()
    multipliers_unique: bool | None = None
    differentiable: bool | None = None
    smallest_inactive_slack: float | None = None
    smallest_active_multiplier: float | None = None
    error_bound: float | None = None
    gap: float | None = None
    step: StepData | None = None

    @property
    def step_sha256(self) -> str | None:
        """SHA-256 of the step that it is about, as in a solution file; formed when it is read."""
        return None if self.step is None else step_sha256(self.step)

    def is_of(self, step: StepData) -> bool:
        """Whether it is about this step: the same object, or one with the same SHA-256."""
        return self.step is step or self.step_sha256 == step_sha256(step)


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
        Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at the rounded answer, in natural units [-].

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
        step=step,
    )


def verify(
    step: StepData,
    delta_q: Array,
    active: Sequence[tuple[int, int]],
    lam: Array | None = None,
    claims: Certificate | None = None,
) -> Verdict:
    """Whether delta_q is the exact optimum of a step, rounded correctly.

    Where a certificate of another kind claims less: whether that claim holds.

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
        refused, and so are kind ``"none"``, which claims nothing, and ``"residual"`` without a
        bound.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        If nothing can be proved in this thread: see :mod:`~quasistatic_ref.certify.arithmetic`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> solution = qr.solve_step(step)
    >>> bool(qr.verify(step, solution.delta_q, solution.certificate.active))
    True
    """
    if claims is not None and claims.kind != "none" and not claims.is_of(step):
        return Verdict(False, "the certificate is of another step")
    if claims is not None and claims.kind == "residual":
        with needing('a certificate of kind "residual"'):
            from quasistatic_ref.optional.large.judged import bound_verdict
        return bound_verdict(step, delta_q, lam, claims.error_bound)
    curved = cone(step.cone).curved
    if curved is not None:
        return curved.verdict(step, delta_q, active, lam, claims)
    if claims is not None and claims.kind != "exact":
        return Verdict(False, f"a certificate of kind {claims.kind!r} proves nothing here")
    try:
        working = flat_rows(step, active)
    except IndexError as error:
        return Verdict(False, str(error))
    delta_q_exact = np.zeros(step.n_v)
    lam_exact = np.zeros(step.m)
    reason = ""
    solved = []
    for group in groups(step):
        form = StepForm(step, group)
        working_rows = group.within(working)
        try:
            exact = fraction_solution(form, working_rows)
        except ZeroDivisionError:
            return Verdict(False, "the rows of the working set are not independent")
        with ctx.workprec(EXACT):
            slack = form.slacks(range(form.m), exact.z)  # times the denominator
            times_h = exact.denominator * form.h
        delta_q_exact[group.coordinates] = rounded_quotients(exact.x, exact.denominator)
        lam_exact[group.rows[working_rows]] = rounded_quotients(exact.y, times_h)
        reason = reason or _wrong_sign(step, group, working_rows, exact.y, slack)
        solved.append((form, working_rows, exact, slack))
    reason = reason or wrong_bits("delta_q", delta_q, delta_q_exact)
    if lam is not None and not reason:
        reason = wrong_bits("lam", lam, lam_exact)
    if claims is not None and not reason:
        reason = _wrong_claim(solved, claims, lam_exact[list(working)])
    return Verdict(not reason, reason)


def _wrong_sign(
    step: StepData, group: Group, working: Sequence[int], y: Sequence[arb], slack: Sequence[arb]
) -> str:
    for i, y_i in zip(working, y, strict=True):
        if y_i <= 0:
            sign = "negative" if y_i < 0 else "zero"
            return f"the multiplier of {_row_name(step, group.rows[i])} is {sign}"
    for i, slack_i in zip(group.rows, slack, strict=True):
        if slack_i < 0:
            return f"{_row_name(step, i)} is violated by the minimiser on the working set"
    return ""


def _wrong_claim(
    solved: Sequence[tuple[ExactForm, Sequence[int], Solution, Sequence[arb]]],
    claims: Certificate,
    lam_w: Array,
) -> str:
    """What is wrong with the claims, from each group's form, working set and solution."""
    unique = smooth = True
    slacks: list[float] = []
    for form, working, exact, slack in solved:
        idle = [i for i, s in enumerate(slack) if s.is_zero() and i not in working]
        of_W = implied_rows(form, working, idle)
        others = [i for i in idle if i not in of_W]
        is_unique, is_smooth = degeneracy(form, working, of_W, others)
        unique = unique and is_unique
        smooth = smooth and is_smooth
        inactive = [s for s in slack if not s.is_zero()]
        slacks += rounded_quotients(inactive, exact.denominator).tolist()
    right = {
        "error_bound": 0.0,
        "gap": None,
        "multipliers_unique": unique,
        "differentiable": smooth,
        "smallest_inactive_slack": min(slacks, default=None) if smooth else 0.0,
        "smallest_active_multiplier": min(lam_w.tolist(), default=None),
    }
    wrong = (wrong_claim(name, getattr(claims, name), value) for name, value in right.items())
    return next(filter(None, wrong), "")


def _row_name(step: StepData, i: int) -> str:
    ((owner, (name,)),) = row_owners(step, [i]).items()
    return f"row {name} of {owner}"
