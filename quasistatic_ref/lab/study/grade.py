"""A reply against the exact answer: correct digits, residuals, and whether its claim holds.

Errors and digits are computed in natural units, whichever units the solver was called in: the
conversion is lossless, and digits are relative. Residuals are those in the units of the call.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from quasistatic_ref.certify.norm import EnergyNorm, digits_of_error, energy_norm
from quasistatic_ref.formats.quoting import clipped
from quasistatic_ref.lab.study.claims import INFEASIBLE, NEITHER, OPTIMAL, claim
from quasistatic_ref.lab.study.false_claims import (
    Terms,
    certificate_holds,
    exact_terms,
    exceeded,
    largest,
    limits,
    terms_of,
)
from quasistatic_ref.lab.study.problems.names import NATURAL, RAW
from quasistatic_ref.lab.study.problems.problem import Answer, Problem
from quasistatic_ref.lab.study.promises import RESIDUALS, UNSTATED, Promise
from quasistatic_ref.lab.study.row import FAILED, NAN, SOLVED, WRONG_SHAPE
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.step.units import Units

SLACK = 1e-13
"""Slacks below that, relative to the numbers that they are the difference of, may be rounding."""


@dataclass(frozen=True, eq=False)
class ProblemForms:
    """A problem in both units, with what the grading of calls needs.

    Parameters
    ----------
    forms : dict of str to StandardForm
        By units, ``"raw"`` and ``"natural"``.
    units : Units
    answer : Answer
        In natural units.
    norm : EnergyNorm
        Of the problem in natural units.
    length : float
        That errors are divided by, in natural units [-].
    terms : dict of str to mapping or None
        By units, what promises are about; None where there is no solution.
    """

    forms: dict[str, StandardForm]
    units: Units
    answer: Answer
    norm: EnergyNorm
    length: float
    terms: dict[str, Terms | None]


@lru_cache(maxsize=8)  # of the problem at which all solvers are
def problem_forms(problem: Problem) -> ProblemForms:
    """A problem in both units, and the norm that errors are measured in."""
    natural = problem.natural
    forms = {RAW: problem.form, NATURAL: natural.form}
    norm = energy_norm(natural.H.toarray())
    answers = {RAW: problem.answer, NATURAL: natural.answer}
    terms = {units: exact_terms(forms[units], answers[units]) for units in forms}
    length = natural.error_length
    return ProblemForms(forms, problem.units, natural.answer, norm, length, terms)


def grades(
    ready: ProblemForms,
    units: str,
    reply: Reply,
    solver: Solver,
    promise: Promise,
    accuracy: float | None,
) -> dict[str, Any]:
    """Outcome, claim, digits, residuals and limits of one reply, as fields of a row.

    Parameters
    ----------
    ready : ProblemForms
    units : str
        ``"raw"`` or ``"natural"``.
    reply : Reply
    solver : Solver
        By whose exit codes a status is a claim.
    promise : dict
        Of the residuals of an answer that it calls optimal.
    accuracy : float or None
        That was asked for [-].

    Returns
    -------
    dict
    """
    form = ready.forms[units]
    outcome, x, lam = _usable_numbers(form, reply)
    claimed = claim(solver.door, solver.target, reply.status)
    if reply.solved and outcome != WRONG_SHAPE:
        claimed = OPTIMAL
    elif claimed == OPTIMAL:
        claimed = NEITHER
    feasible = not ready.answer.farkas
    fields = ungraded_fields(outcome, reply.status, feasible)
    residuals: dict[str, float | None] = dict.fromkeys(RESIDUALS)
    with np.errstate(all="ignore"):
        terms = ready.terms[units] or terms_of(form, x, lam)
        if x is not None:
            residuals = _residuals(form, x, lam)
            if units == RAW:
                x = x / (ready.units.size * ready.units.coordinate)
                lam = None if lam is None else lam * (ready.units.length / ready.units.size)
            if feasible:
                fields |= _digits(ready, x, lam)
        allowed = limits(promise, terms, residuals, feasible)
    overflows = any(size is not None and not np.isfinite(size) for size in residuals.values())
    wrong = claimed == OPTIMAL and (x is None or overflows or exceeded(residuals, allowed))
    if claimed == INFEASIBLE and feasible:
        wrong = not _is_certified(form, reply.lam, accuracy or UNSTATED["abs"])
    return (
        fields
        | {name: _finite(size) for name, size in residuals.items()}
        | {
            **{f"{name}_limit": most for name, most in allowed.items()},
            "claim": claimed,
            "false_claim": wrong,
            "seconds_solver": _finite(reply.seconds),
            "seconds_setup": _finite(reply.setup),
            "iterations": reply.iterations,
        }
    )


def _is_certified(form: StandardForm, lam: Array | None, accuracy: float) -> bool:
    usable = lam is not None and lam.shape == form.b.shape
    return lam is not None and usable and certificate_holds(form, lam, accuracy)


def ungraded_fields(outcome: str, status: str, feasible: bool) -> dict[str, Any]:
    """The same fields of a call that never came back, or never was made."""
    every = ["digits", "digits_net", "digits_lam", *RESIDUALS]
    every += [f"{name}_limit" for name in RESIDUALS]
    times = ("seconds", "seconds_low", "seconds_high", "seconds_first", "seconds_solver",
             "seconds_setup")  # fmt: skip
    return dict.fromkeys([*every, *times, "iterations", "memory"]) | {
        "outcome": outcome,
        "status": clipped(status),
        "feasible": feasible,
        "claim": NEITHER,
        "false_claim": False,
        "calls": 0,
    }


def _usable_numbers(form: StandardForm, reply: Reply) -> tuple[str, Array | None, Array | None]:
    """Outcome, and the numbers if they can be judged."""
    if reply.x is None:
        return FAILED, None, None
    if reply.x.shape != form.g.shape or (reply.lam is not None and reply.lam.shape != form.b.shape):
        return WRONG_SHAPE, None, None
    lam_finite = reply.lam is None or bool(np.isfinite(reply.lam).all())
    if not np.isfinite(reply.x).all() or not lam_finite:
        # A solver that gave up and says so has failed, whatever it left in its arrays.
        return (NAN if reply.solved else FAILED), None, None
    return (SOLVED if reply.solved else FAILED), reply.x, reply.lam


def _digits(of: ProblemForms, x: Array, lam: Array | None) -> Mapping[str, float]:
    answer = of.answer
    digits = {"digits": _digits_of(of.norm.of_displacement(x - answer.x), of)}
    if lam is None:
        return digits
    form = of.forms[NATURAL]
    net = form.A.T @ lam - answer.net
    negative = form.A.T @ np.minimum(lam, 0.0)
    off, below = (float(one) for one in of.norm.of_impulses(np.array([net, negative])))
    # Slacks of the exact answer that rounding alone may have made are none. What multipliers of
    # others add to the dual's gap bounds an error by strong convexity, as a gap does.
    slack = form.A @ answer.x - form.b
    slack[slack < SLACK * (abs(form.A) @ abs(answer.x) + abs(form.b))] = 0.0
    gap = float(np.maximum(lam, 0.0) @ slack)
    worst = max(off, below, float(np.sqrt(2 * gap)))
    return digits | {"digits_net": _digits_of(off, of), "digits_lam": _digits_of(worst, of)}


def _digits_of(size: float, of: ProblemForms) -> float:
    return digits_of_error(size / of.length)


def _residuals(form: StandardForm, x: Array, lam: Array | None) -> dict[str, float | None]:
    """Primal and dual residual and duality gap, in the call's units.

    They are those of qpbenchmark, except that a negative multiplier is a dual residual, too.
    """
    primal = largest(np.maximum(form.b - form.A @ x, 0.0))
    if lam is None:
        return {"primal": primal, "dual": None, "gap": None}
    balance = form.H @ x - form.g - form.A.T @ lam
    gap = abs(float(x @ form.H @ x - form.g @ x - form.b @ lam))
    return {
        "primal": primal,
        "dual": float(np.max([largest(balance), largest(np.minimum(lam, 0.0))])),
        "gap": gap,
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None
