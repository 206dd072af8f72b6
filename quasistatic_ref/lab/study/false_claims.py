"""Whether a claim is false: the residuals of an answer against what its solver promised.

A solver controls residuals, and not digits: an answer that keeps every tolerance may be far from
the exact one where multipliers are large, (R48). So a claim of success is false if a residual is
larger than the promise of it, evaluated at the exact answer:

    residual > FACTOR (abs + rel max(terms) + rounding).

At the exact answer, because there every term but ``|lam|`` is unique: a huge x excuses nothing. Of
a problem without a solution they are taken at the answer that was returned, as the solver does.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.problems.problem import Answer
from quasistatic_ref.lab.study.promises import RESIDUALS, Promise
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.standard_form import StandardForm

FACTOR = 10.0
"""By how much a residual may exceed its promise, the same for all solvers. They test residuals of
variables that they have scaled, before the interface converts the answer, and terms at their own
answer. In the study `default`, 28 answers exceed a promise by less than that and 10 by more, those
of HiGHS and ProxQP left out."""
SPREAD = 1e3
"""Multipliers are not unique, and an interior point that ends among many may be far out: Clarabel's
on narrow/5.29681e-11/203 are 860 times the exact ones. ``|lam|`` counts that much larger."""
Terms = Mapping[str, float]


def exact_terms(form: StandardForm, answer: Answer) -> Terms | None:
    """The terms of a problem at its exact answer, in the same units; None if it has no solution."""
    return None if answer.farkas else terms_of(form, answer.x, answer.lam, SPREAD)


def terms_of(form: StandardForm, x: Array | None, lam: Array | None, spread: float = 1.0) -> Terms:
    """The terms that promises name, at an answer.

    Parameters
    ----------
    form : StandardForm
    x, lam : ndarray, shapes (n,) and (m,), or None
        In the same units; None counts as zeros.
    spread : float
        By how much ``|lam|`` counts larger [-].

    Returns
    -------
    dict of str to float
        Also the sizes of what each residual sums up, whose rounding is the solver's by no fault.
    """
    n, m = len(form.g), len(form.b)
    x = np.zeros(n) if x is None else x
    lam = np.zeros(m) if lam is None else lam
    s = form.A @ x - form.b
    absolute = StandardForm(abs(form.H), abs(form.g), abs(form.A), abs(form.b))
    primal = absolute.A @ abs(x) + absolute.b
    dual = absolute.H @ abs(x) + absolute.g + absolute.A.T @ abs(lam)
    gap = abs(x) @ (absolute.H @ abs(x) + absolute.g) + absolute.b @ abs(lam)
    rounding = (n + m) * np.finfo(float).eps
    quadratic = float(x @ form.H @ x)
    linear = float(form.g @ x)
    return {
        "1": 1.0,
        "m": float(m),
        "|b|": largest(form.b),
        "|b|2": float(np.linalg.norm(form.b)),
        "|g|": largest(form.g),
        "|g|2": float(np.linalg.norm(form.g)),
        "|x|2": float(np.linalg.norm(x)),
        "|s|": largest(s),
        "|s|2": float(np.linalg.norm(s)),
        "|lam|2": spread * float(np.linalg.norm(lam)),
        "|Ax|": largest(form.A @ x),
        "|Hx|": largest(form.H @ x),
        "|A'lam|": largest(form.A.T @ lam),
        "|x'Hx|": quadratic,
        "|g'x|": abs(linear),
        "|b'lam|": abs(float(form.b @ lam)),
        "cost": abs(quadratic / 2 - linear),
        "primal": rounding * largest(primal),
        "dual": rounding * largest(dual),
        "gap": rounding * float(gap),
        "|x|1": float(abs(x).sum()),
        "|lam|1": float(abs(lam).sum()),
    }


def largest(values: Array) -> float:
    """The largest size of an entry; 0 of none.

    Parameters
    ----------
    values : ndarray, shape (n,) [any]

    Returns
    -------
    float [any]
    """
    return float(abs(values).max(initial=0.0))


def limits(
    promise: Promise, terms: Terms, residuals: Mapping[str, Any], feasible: bool
) -> dict[str, float | None]:
    """The largest residuals that a promise allows; None where it says nothing.

    Parameters
    ----------
    promise : dict
    terms : mapping
    residuals : mapping
        Of the answer: what they add to the gap of a pair that is complementary is no sin.
    feasible : bool
        Of a problem without a solution complementarity is not judged.
    """
    stated = {name: criterion for name, criterion in promise.items() if criterion}
    allowed = {
        name: _limit(name, criterion, terms, residuals, feasible)
        for name, criterion in stated.items()
    }
    return dict.fromkeys(RESIDUALS) | allowed


def _limit(
    name: str, criterion: Promise, terms: Terms, residuals: Mapping[str, Any], feasible: bool
) -> float | None:
    sums = (sum(terms[term] for term in words.split(" + ")) for words in criterion["of"])
    allowed = criterion["abs"] + criterion["rel"] * max(sums) + terms[name]
    if not np.isfinite(allowed) or (criterion["complementarity"] and not feasible):
        return None
    if criterion["complementarity"]:
        # x'Hx - g'x - b'lam = x'(Hx - g - A'lam) + lam'(Ax - b)
        allowed += terms["|x|1"] * (residuals["dual"] or 0.0)
        allowed += terms["|lam|1"] * (residuals["primal"] or 0.0)
    return float(FACTOR * allowed)


def exceeded(residuals: Mapping[str, float | None], limit: Mapping[str, float | None]) -> bool:
    """Whether a residual is larger than its limit.

    Parameters
    ----------
    residuals, limit : mapping
        By the names of the residuals, in the same units [any]; None: not known, or not judged.
    """
    pairs = ((residuals[name], limit[name]) for name in RESIDUALS)
    return any(size is not None and most is not None and size > most for size, most in pairs)


def certificate_holds(form: StandardForm, y: Array, accuracy: float) -> bool:
    """Whether y proves, to an accuracy, that no x has A x >= b: y >= 0, A'y = 0 and b'y > 0.

    Parameters
    ----------
    form : StandardForm
    y : ndarray, shape (m,)
        In any multiple [-].
    accuracy : float
        That was asked for, relative to the largest entry of y [-].
    """
    size = largest(y)
    if not np.isfinite(size) or size == 0:
        return False
    tolerance = FACTOR * accuracy
    y = y / size
    balanced = largest(form.A.T @ y) <= tolerance
    return bool(y.min() >= -tolerance and balanced and form.b @ y > 0)
