"""The answer of each kind of problem: exact, enclosed, bounded, or a proof that there is none."""

import math
from collections.abc import Iterator

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from quasistatic_ref.certify.exact import ExactOptimum, exact_optimum
from quasistatic_ref.certify.rational import exact_form_of
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.study.problems.plain_sizes import PlainSizes
from quasistatic_ref.lab.study.problems.problem import BOUNDED, ENCLOSED, EXACT, Answer
from quasistatic_ref.lab.study.problems.truth import reply_of
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure
from quasistatic_ref.optional.large.sparse_bound import LargeForm, Metric, sparse_error_bound
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import KNOWN

NONE = np.zeros(0)
LARGE_SOLVERS = ("piqp", "clarabel")
"""Solvers of a sparse problem; the sharper bound is kept."""


class NotKnown(QuasistaticError):
    """A problem whose answer could not be proved."""


def exact_answer(form: StandardForm) -> Answer:
    """The exact answer of a quadratic program, or an exact proof that it has none; from cold.

    Parameters
    ----------
    form : StandardForm
        Any units.
    """
    found = exact_optimum(exact_form_of(*form))
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
    form = LargeForm(Metric(csc_matrix(H)), g, csc_matrix(A), b, PlainSizes(A, g))
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
