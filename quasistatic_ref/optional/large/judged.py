r"""The bound that an uncertified answer claims, proved from the exact optimum.

.. math:: \|x - x^*\|_H^2 + 2 (f(x^*) - d(\lambda)) \le (\text{error\_bound}\; \|H^{-1} g\|_H)^2

bounds the errors of displacement and multipliers in one number: the second term is zero for optimal
multipliers alone. Where the optimum is not known,
:mod:`~quasistatic_ref.optional.large.bound` proves this claim: a feasible x' has
1/2 ||x' - x*||_H^2 + f(x*) - d <= f(x') - d, and the triangle inequality adds
||x - x'||_H. Here all terms are rational, and compared without a root.
"""

import math

import numpy as np

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import form_optimum
from quasistatic_ref.certify.form import StepForm, fraction
from quasistatic_ref.certify.minimiser import fraction_solution
from quasistatic_ref.certify.verdict import Verdict
from quasistatic_ref.optional.gap import duality_gap, energy, fractions, free_energy
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import WORTHLESS


def bound_verdict(
    step: StepData, delta_q: Array, lam: Array | None, claimed: float | None
) -> Verdict:
    """Whether an answer of kind ``"residual"`` is within the error that it claims.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,), or None
    claimed : float or None
        ``error_bound`` [-].

    Returns
    -------
    Verdict
    """
    if claimed is None or lam is None or not cone(step.cone).polyhedral:
        return Verdict(False, "a certificate of kind 'residual' without a bound proves nothing")
    form = StepForm(step)
    if delta_q.shape != (form.n,) or lam.shape != (form.m,):
        return Verdict(False, "delta_q or lam has another shape than the step wants")
    if not (np.isfinite(delta_q).all() and np.isfinite(lam).all() and math.isfinite(claimed)):
        return Verdict(False, "delta_q, lam or error_bound is not finite")
    if not 0 <= claimed <= WORTHLESS:
        return Verdict(False, f"error_bound is {claimed!r}; a bound is from 0 to {WORTHLESS:g}")
    if lam.min(initial=0.0) < 0:
        return Verdict(False, "a multiplier is negative")
    optimum = form_optimum(form, np.argsort(-lam, kind="stable")[: int((lam > 0).sum())].tolist())
    if isinstance(optimum, Farkas):
        return Verdict(False, "the step has no solution")
    x = fraction_solution(form, optimum.working_set).point
    off = [a - b for a, b in zip(fractions(delta_q), x, strict=True)]
    gap = duality_gap(form, x, fractions(lam))
    bound = fraction(claimed)
    if energy(form, off) + gap <= bound * bound * free_energy(form):
        return Verdict(True)
    return Verdict(False, f"error_bound is claimed to be {claimed!r}; the error is larger")
