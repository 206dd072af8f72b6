"""The answer of each kind of problem: exact, enclosed, bounded, or a proof that there is none."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from quasistatic_ref.certify.exact import ExactOptimum, exact_optimum
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.study.calling.calls import tried
from quasistatic_ref.lab.study.problems.plain_sizes import PlainSizes
from quasistatic_ref.lab.study.problems.problem import BOUNDED, ENCLOSED, EXACT, Answer
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure
from quasistatic_ref.optional.large.bound import enclosed_answer
from quasistatic_ref.optional.large.sparse_bound import LargeForm, SparseHessian, sparse_error_bound
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.backends import BACKENDS, installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import Units, natural_form, natural_hessian, units_of
from quasistatic_ref.step.data import Array, Contacts, Extra, StepData
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import ACCURACY, KNOWN

NONE = np.zeros(0)
EXACT_COORDINATES = 60
"""Coordinates up to which every problem is solved exactly: 30 ms at 15 of them, 0.3 s at 24 and
3 s at 48, from no rows."""
WITNESSES = ("daqp", "clarabel", "piqp")
"""Solvers that are called, in this order, for the rows of an enclosure."""
LARGE_SOLVERS = ("piqp", "clarabel")
"""Solvers of a sparse problem; the sharper bound is kept."""


class NotKnown(QuasistaticError):
    """A problem whose answer could not be proved."""


def dense_answer(form: StandardForm) -> Answer:
    """The exact answer of a problem; beyond 60 coordinates an enclosure, if one is tight enough.

    Parameters
    ----------
    form : StandardForm
        SI units.
    """
    if len(form.g) <= EXACT_COORDINATES:
        return exact_answer(form)
    natural = natural_form(form, units_of(form, natural_hessian(form.H)))
    warm: list[int] = []
    for solver in WITNESSES:
        reply = reply_of(natural, solver)
        if reply is None or reply.x is None or reply.lam is None or not reply.solved:
            continue
        warm = warm_rows(natural.A, reply.lam, natural.A @ reply.x - natural.b)
        found = enclosed_answer(step_of(form), warm)
        if found is not None and found.error < KNOWN:
            slack = form.A @ found.delta_q - form.b
            return Answer(ENCLOSED, found.error, found.delta_q, found.net, slack, found.lam, {})
    return exact_answer(form, warm)


def exact_answer(form: StandardForm, warm: Sequence[int] = ()) -> Answer:
    """The exact answer of a quadratic program, or an exact proof that it has none.

    Parameters
    ----------
    form : StandardForm
        Any units.
    warm : sequence of int
        Rows that the exact method starts from.
    """
    found = exact_optimum(exact_form_of(*form), warm)
    if isinstance(found, ExactOptimum):
        return Answer(EXACT, 0.0, found.delta_q, found.net, found.slack, found.lam, {},
                      found.walks, found.multipliers_unique, found.differentiable)  # fmt: skip
    largest = max(found.y.values())
    farkas = {int(i): str(found.y[i] / largest) for i in sorted(found.y)}
    return Answer(EXACT, 0.0, NONE, NONE, NONE, NONE, farkas)


def cone_answer(step: StepData, form: StandardForm) -> Answer:
    """The answer in second-order cones, each number off by its rounding at most.

    Parameters
    ----------
    step : StepData
        In the ellipsoid, friction being 1.
    form : StandardForm
        Its blocks of four rows.

    Raises
    ------
    NotKnown
        If none is enclosed.
    """
    found = enclosure(step)
    if found is None:
        raise NotKnown("no answer was enclosed")
    slack = form.A @ found.delta_q - form.b
    return Answer(ENCLOSED if found.error else EXACT, found.error, found.delta_q, found.net,
                  slack, found.lam, {})  # fmt: skip


def bounded_answer(H: csr_matrix, g: Array, A: csr_matrix, b: Array, units: Units) -> Answer:
    """A solver's answer to a sparse problem, with a proved bound of its error.

    Parameters
    ----------
    H, A : csr_matrix, shapes (n, n) and (m, n)
        In natural units, as g (n,) and b (m,).
    g, b : ndarray
    units : Units
        For the answer in SI units.

    Raises
    ------
    NotKnown
        If no bound is at most 1e-6.
    """
    form = LargeForm(SparseHessian(csc_matrix(H)), g, csc_matrix(A), b, PlainSizes(A, g))
    best = (math.inf, NONE, NONE)
    for x, lam in _answers(StandardForm(csc_matrix(H), g, csc_matrix(A), b)):
        error = sparse_error_bound(form, x, lam)
        best = min(best, (error, x, lam), key=lambda found: found[0])
    error, x, lam = best
    if not error <= KNOWN:
        raise NotKnown(f"no bound is at most {KNOWN:g}")
    S, ell, rho = units.coordinate, units.length, units.size
    return Answer(BOUNDED, error, x * (rho * S), (A.T @ lam) * rho / S,
                  (A @ x - b) * (rho * ell), lam * (rho / ell), {})  # fmt: skip


def _answers(form: StandardForm) -> Iterator[tuple[Array, Array]]:
    for solver in LARGE_SOLVERS:
        reply = reply_of(form, solver)
        if reply is not None and reply.x is not None and reply.lam is not None:
            yield reply.x, np.maximum(reply.lam, 0.0)


def reply_of(natural: StandardForm, solver: str) -> Reply | None:
    """What a solver says to a problem in natural units; None if it is not installed."""
    if solver not in installed("qpsolvers"):
        return None
    options = BACKENDS[solver].first(ACCURACY)
    return tried(qpsolvers_reply, natural, solver, options)


def step_of(form: StandardForm) -> StepData:
    """The step whose standard form is a given quadratic program: h = 1, K_q = H, rows as extra."""
    n, m = len(form.g), len(form.b)
    nothing, frames = np.zeros(0), np.zeros((0, 3))
    return StepData(
        h=1.0,
        K_q=form.H,
        M_u=np.zeros((0, 0)),
        tau_a=form.g,
        tau_u=nothing,
        delta_q_bar_a=np.zeros(n),
        contacts=Contacts((), nothing, frames, frames, frames, np.zeros((0, 4, n)), nothing,
                          nothing, np.zeros(0, dtype=np.int64)),
        extra=Extra(tuple(f"row {i}" for i in range(m)), form.A, form.b),
    )  # fmt: skip
