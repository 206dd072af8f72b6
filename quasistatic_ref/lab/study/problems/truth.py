"""The exact answer of a plain quadratic program, or a rigorous enclosure of it."""

from quasistatic_ref.certify.exact import ExactOptimum, exact_optimum
from quasistatic_ref.certify.rational import exact_form_of
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.study.calling.calls import tried
from quasistatic_ref.lab.study.problems.qp import Truth, step_of, units_of
from quasistatic_ref.optional.large.bound import enclosed_answer
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.solve.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.units import natural_form
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import ACCURACY, KNOWN

EXACT_COORDINATES = 60
"""Coordinates up to which every problem is solved exactly: 4 ms at 15 of them, 50 ms at 30, 1 s at
60, but 11 s at 120, where the enclosure takes 0.2 s."""

WITNESSES = ("daqp", "clarabel", "piqp")
"""Solvers that are called, in this order, for the rows that the exact method starts from."""


class NoAnswer(QuasistaticError):
    """A problem whose exact answer was not found."""


def answer_of(form: StandardForm) -> Truth:
    """The exact answer of a problem; beyond 60 coordinates an enclosure, if one is tight enough.

    Parameters
    ----------
    form : StandardForm
        SI units.

    Returns
    -------
    Truth

    Raises
    ------
    NoAnswer
        If the problem has no solution.
    """
    natural = natural_form(form, units_of(form))
    warm: list[int] = []
    for solver in WITNESSES:
        reply = reply_of(natural, solver)
        if reply is None or reply.x is None or reply.lam is None or not reply.solved:
            continue
        warm = warm_rows(natural.A, reply.lam, natural.A @ reply.x - natural.b)
        if len(form.g) <= EXACT_COORDINATES:
            break
        enclosed = enclosed_answer(step_of(form), warm)
        if enclosed is not None and enclosed.error < KNOWN:
            return Truth(enclosed.delta_q, enclosed.net, enclosed.error)
    optimum = exact_optimum(exact_form_of(form.H, form.g, form.A, form.b), warm)
    if not isinstance(optimum, ExactOptimum):
        raise NoAnswer("has no solution")
    return Truth(optimum.delta_q, optimum.net, 0.0)


def reply_of(natural: StandardForm, solver: str) -> Reply | None:
    """What a solver says to a problem in natural units; None if it is not installed."""
    if solver not in installed("qpsolvers"):
        return None
    options = BACKENDS[solver].first(ACCURACY)
    return tried(lambda: qpsolvers_reply(natural, solver, options))
