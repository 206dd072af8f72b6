"""A reply against the truth: correct digits, residuals, and whether its claim holds.

Everything is measured in natural units, whichever units the solver was asked in: the conversion is
lossless, and digits, which are relative, do not notice.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.certify.digits import MOST, digits_of_error
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm
from quasistatic_ref.lab.study.qp import Problem, Truth, units_of
from quasistatic_ref.quoting import clipped
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.solve.units import Units, natural_form
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

SOLVED, FAILED, NAN, WRONG_SHAPE = "solved", "failed", "nan", "wrong_shape"
CRASHED, TIMEOUT, NOT_RUN = "crashed", "timeout", "not_run_budget"
OUTCOMES = (SOLVED, FAILED, CRASHED, TIMEOUT, NAN, WRONG_SHAPE, NOT_RUN)


@dataclass(frozen=True, eq=False)
class Exam:
    """A problem prepared for asking and grading.

    Parameters
    ----------
    forms : dict of str to StandardForm
        By units, ``"raw"`` and ``"natural"``.
    units : Units
    answer : Truth
        In natural units.
    norm : EnergyNorm
        Of the problem in natural units.
    free : float
        ||H^-1 g||_H in natural units [-].
    """

    forms: dict[str, StandardForm]
    units: Units
    answer: Truth
    norm: EnergyNorm
    free: float


def exam(problem: Problem) -> Exam:
    """A problem prepared: its natural units, and the norm that errors are measured in."""
    units = units_of(problem.form)
    natural = natural_form(problem.form, units)
    norm = energy_norm(natural.H)
    S, rho = units.coordinate, units.size
    answer = Truth(
        problem.answer.delta_q / (rho * S), problem.answer.net * S / rho, problem.answer.bound
    )
    free = float(norm.impulses(natural.g[None])[0])
    return Exam({"raw": problem.form, "natural": natural}, units, answer, norm, free)


def grades(paper: Exam, asked_in: str, reply: Reply, promised: float) -> dict[str, Any]:
    """Outcome, claim, digits, residuals, times of one reply, as fields of a row.

    Parameters
    ----------
    paper : Exam
    asked_in : str
        ``"raw"`` or ``"natural"``.
    reply : Reply
    promised : float
        Digits [-] of delta_q below which "optimal" is a false claim.

    Returns
    -------
    dict
    """
    outcome, x, lam = _usable(paper.forms[asked_in], reply)
    row = ungraded(outcome, reply.status, reply.call_seconds)
    with np.errstate(all="ignore"):
        if x is not None:
            row["residuals"] = _residuals(paper.forms[asked_in], x, lam)
            if asked_in == "raw":
                x = x / (paper.units.size * paper.units.coordinate)
                lam = None if lam is None else lam * (paper.units.length / paper.units.size)
            row["digits"] = _digits(paper, x, lam)
    found = row["digits"]["delta_q"]
    row["wrong"] = reply.solved and (found is None or found < promised)
    row["seconds"]["solver"] = _finite(reply.seconds)
    return row | {"said_optimal": reply.solved, "iterations": reply.iterations}


def ungraded(outcome: str, claimed: str, seconds: float) -> dict[str, Any]:
    """The same fields of a call that never came back, after `seconds` [s], or never was made."""
    return {
        "outcome": outcome,
        "claimed": clipped(claimed),
        "said_optimal": False,
        "wrong": False,
        "digits": {"delta_q": None, "net_wrench": None},
        "residuals": {"primal": None, "dual": None, "gap": None},
        "seconds": {"solver": None, "call": seconds},
        "iterations": None,
    }


def _usable(form: StandardForm, reply: Reply) -> tuple[str, Array | None, Array | None]:
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


def _digits(paper: Exam, x: Array, lam: Array | None) -> dict[str, float | None]:
    answer, form = paper.answer, paper.forms["natural"]
    off = paper.norm.displacement(x - answer.delta_q)
    net = None
    if lam is not None:
        net = float(paper.norm.impulses((form.A.T @ lam - answer.net)[None])[0])
    return {
        "delta_q": _digits_of(off, paper),
        "net_wrench": None if net is None else _digits_of(net, paper),
    }


def _digits_of(size: float, paper: Exam) -> float:
    if paper.free == 0:
        return MOST if size == 0 else 0.0
    # Of an enclosure no more digits are reported than are known.
    return digits_of_error(max(size / paper.free, paper.answer.bound))


def _residuals(form: StandardForm, x: Array, lam: Array | None) -> dict[str, float | None]:
    """Primal and dual residual and duality gap, as qpbenchmark defines them, in units as asked."""
    slack = form.A @ x - form.b
    primal = float(np.maximum(-slack, 0.0).max(initial=0.0))
    if lam is None:
        return {"primal": _finite(primal), "dual": None, "gap": None}
    balance = form.H @ x - form.g - form.A.T @ lam
    gap = abs(float(x @ form.H @ x - form.g @ x - form.b @ lam))
    return {
        "primal": _finite(primal),
        "dual": _finite(float(np.abs(balance).max(initial=0.0))),
        "gap": _finite(gap),
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and np.isfinite(value) else None
