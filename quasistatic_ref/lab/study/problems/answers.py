"""The exact answer of a problem, or an exact proof that there is none."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.lab.study.calling.calls import tried
from quasistatic_ref.lab.study.problems.problem import EXACT, Answer
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import hessian_in_both_units, natural_form, units_of
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import ACCURACY

NONE = np.zeros(0)
FROM_NOTHING = 60
"""Coordinates up to which the exact method starts from no rows, without a solver: 0.2 s at 60 of
them, 12 s at 150."""
WITNESSES = ("piqp", "clarabel", "daqp")
"""Solvers that are called, in this order, for the rows that the exact method starts from."""


def dense_answer(form: StandardForm) -> Answer:
    """The exact answer of a problem, or an exact proof that it has none.

    Parameters
    ----------
    form : StandardForm
        SI units.
    """
    return exact_answer(form, [] if len(form.g) <= FROM_NOTHING else _pressed(form))


def _pressed(form: StandardForm) -> list[int]:
    """Rows that a solver found active; none if it found no answer."""
    hessian = hessian_in_both_units(form.H)
    natural = natural_form(form, units_of(form, hessian), hessian.natural_H)
    for solver in WITNESSES:
        reply = reply_of(natural, solver)
        if reply is not None and reply.solved and reply.x is not None and reply.lam is not None:
            return warm_rows(natural.A, reply.lam, natural.A @ reply.x - natural.b)
    return []


def exact_answer(form: StandardForm, warm: Sequence[int] = ()) -> Answer:
    """The exact answer of a quadratic program, or an exact proof that it has none.

    Parameters
    ----------
    form : StandardForm
        Any units.
    warm : sequence of int
        Rows that the exact method starts from.
    """
    found = form_optimum(exact_form_of(*form), warm)
    if isinstance(found, ExactOptimum):
        return Answer(EXACT, 0.0, found.delta_q, found.net, found.slack, found.lam, {},
                      found.walks, found.multipliers_unique, found.differentiable)  # fmt: skip
    largest = max(found.y.values())
    farkas = {int(i): str(found.y[i] / largest) for i in sorted(found.y)}
    return Answer(EXACT, 0.0, NONE, NONE, NONE, NONE, farkas)


def reply_of(natural: StandardForm, solver: str) -> Reply | None:
    """What a solver says to a problem in natural units; None if it is not installed."""
    if solver not in installed("qpsolvers"):
        return None
    options = BACKENDS[solver].first(ACCURACY)
    return tried(qpsolvers_reply, natural, solver, options)
