"""A reply against the exact answer: correct digits, residuals, and whether its claim holds.

Errors and digits are computed in natural units, whichever units the solver was called in: the
conversion is lossless, and digits are relative. Residuals are those in the units of the call.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from quasistatic_ref.certify.norm import EnergyNorm, digits_of_error, energy_norm
from quasistatic_ref.formats.quoting import clipped
from quasistatic_ref.lab.study.calling.claims import INFEASIBLE
from quasistatic_ref.lab.study.calling.promises import UNSTATED
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.measuring.false_claims import (
    Terms,
    certificate_holds,
    exact_terms,
    judged,
    largest,
    terms_of,
)
from quasistatic_ref.lab.study.problems.names import NATURAL, RAW
from quasistatic_ref.lab.study.problems.problem import Answer, Problem
from quasistatic_ref.lab.study.store.rows import (
    CLOCKS,
    FAILED,
    NAN,
    NOT_RUN,
    SOLVED,
    TABLES,
    WRONG_SHAPE,
)
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

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
    form = natural.form
    norm = energy_norm(natural.H.toarray())
    length = problem.error_length / problem.units.size
    raw = problem.form
    terms = {RAW: exact_terms(raw, problem.answer), NATURAL: exact_terms(form, natural.answer)}
    forms = {RAW: raw, NATURAL: form}
    return ProblemForms(forms, problem.units, natural.answer, norm, length, terms)


def grades(
    ready: ProblemForms, units: str, reply: Reply, solver: Solver, setting: Setting
) -> dict[str, Any]:
    """Outcome, claims, digits, residuals of one reply, as fields of a row.

    Parameters
    ----------
    ready : Prepared
    units : str
        ``"raw"`` or ``"natural"``.
    reply : Reply
    solver : Solver
        By whose exit codes a status is a claim.
    setting : Setting

    Returns
    -------
    dict
    """
    form = ready.forms[units]
    outcome, x, lam = _usable_numbers(form, reply)
    row = ungraded_fields(outcome, reply.status, reply.call_seconds, not ready.answer.farkas)
    with np.errstate(all="ignore"):
        terms = ready.terms[units] or terms_of(form, x, lam)
        if x is not None:
            row["residuals"] = _residuals(form, x, lam)
            if units == RAW:
                x = x / (ready.units.size * ready.units.coordinate)
                lam = None if lam is None else lam * (ready.units.length / ready.units.size)
            if not ready.answer.farkas:
                row["digits"] = _digits(ready, ready.answer, x, lam)
    row["seconds"] |= {"solver": _finite(reply.own), "setup": _finite(reply.setup)}
    said = reply.solved and outcome != WRONG_SHAPE  # a mistake in the use of the interface
    row |= {"said_optimal": said, "iterations": reply.iterations}
    claim = solver.claim(reply.status)
    certified = False
    if claim == INFEASIBLE and reply.lam is not None and reply.lam.shape == form.b.shape:
        certified = certificate_holds(form, reply.lam, setting.accuracy or UNSTATED["abs"])
    return judged(row, claim, solver.promises(setting), terms, certified)


def ungraded_fields(
    outcome: str, claimed: str, seconds: float | None, feasible: bool = True
) -> dict[str, Any]:
    """The same fields of a call that never came back, after `seconds` [s], or never was made."""
    return {
        "outcome": outcome,
        "claimed": clipped(claimed),
        "feasible": feasible,
        "said_optimal": False,
        "said_infeasible": False,
        "wrong": False,
        "wrong_multipliers": False,
        "digits": dict.fromkeys(TABLES["digits"]),
        "residuals": dict.fromkeys(TABLES["residuals"]),
        "allowed": dict.fromkeys(TABLES["allowed"]),
        "seconds": dict.fromkeys(CLOCKS) | {"call": seconds},
        "calls": 0,
        "clock_agrees": None,
        "memory": None,
        "iterations": None,
        "repeats": None,
    }


def not_run(feasible: bool) -> dict[str, Any]:
    """The same fields of a call that the budget did not reach."""
    row = ungraded_fields(NOT_RUN, "not run (budget)", None, feasible)
    return row | {"seconds": row["seconds"] | {"spent": 0.0}}


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


def _digits(
    of: ProblemForms, answer: Answer, x: Array, lam: Array | None
) -> dict[str, float | None]:
    digits: dict[str, float | None] = {
        "delta_q": _digits_of(of.norm.of_displacement(x - answer.x), of, answer.error),
        "net_wrench": None,
        "multipliers": None,
    }
    if lam is not None:
        form = of.forms[NATURAL]
        A = form.A
        bound = answer.error
        net = A.T @ lam - answer.net
        negative = A.T @ np.minimum(lam, 0.0)
        off, below = of.norm.of_impulses(np.array([net, negative]))
        digits["net_wrench"] = _digits_of(float(off), of, bound)
        # Slacks of the exact answer that rounding alone may have made are none. What multipliers
        # of others add to the dual's gap bounds an error by strong convexity, as a gap does.
        slack = A @ answer.x - form.b
        slack[slack < SLACK * (abs(A) @ abs(answer.x) + abs(form.b))] = 0.0
        gap = float(np.maximum(lam, 0.0) @ slack)
        worst = max(float(off), float(below), float(np.sqrt(2 * gap)))
        digits["multipliers"] = _digits_of(worst, of, bound)
    return digits


def _digits_of(size: float, of: ProblemForms, bound: float) -> float:
    # Of an enclosure no more digits are reported than are known.
    return digits_of_error(max(size / of.length, bound))


def _residuals(form: StandardForm, x: Array, lam: Array | None) -> dict[str, float | None]:
    """Primal and dual residual and duality gap, in the call's units.

    They are those of qpbenchmark, except that a negative multiplier is a dual residual, too.
    """
    slack = form.A @ x - form.b
    primal = float(np.maximum(-slack, 0.0).max(initial=0.0))
    if lam is None:
        return {"primal": _finite(primal), "dual": None, "gap": None}
    balance = form.H @ x - form.g - form.A.T @ lam
    gap = abs(float(x @ form.H @ x - form.g @ x - form.b @ lam))
    return {
        "primal": _finite(primal),
        "dual": _finite(max(largest(balance), largest(np.minimum(lam, 0.0)))),
        "gap": _finite(gap),
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None
