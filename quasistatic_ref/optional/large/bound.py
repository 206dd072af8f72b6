r"""A rigorous bound of the error of any primal-dual answer, without knowing the optimum.

For a feasible x and any y >= 0, with x_y = H^-1 (g + A'y) the minimiser of the Lagrangian,

.. math:: \tfrac12\|x - x^*\|_H^2 \le f(x) - d(y)
          = \tfrac12\|x - x_y\|_H^2 + y^T (A x - b).

A solver's x is hardly ever feasible to the last bit: x is moved along a direction v with A v > 0,
as far as its worst violation needs, and the distance moved is added to the bound. If x is not
feasible and no such direction is found (a body wedged in), the bound is infinite.

The gap f(x) - d(y) is computed in ball arithmetic and rounded upwards. It bounds the square of an
error: an answer that is right to 1e-16 has a gap of about 1e-16, so that the bound shows some eight
digits. The exact method shows all of them.
"""

import math

import numpy as np
from flint import arb, arb_mat
from scipy.sparse import csc_matrix

from quasistatic_ref.certify.form import PRECISION, StepForm, exact_matrix
from quasistatic_ref.optional.gap import inner, nearest_above, square_root
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.precision import working_precision
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

RIDGE = 1e-10
"""That of ``opening``, so small that directions in narrow wedges are found. Their rounding does no
harm: how far each row opens along them is looked at in balls."""


def error_bound(step: StepData, delta_q: Array, lam: Array) -> float:
    """A bound of ||delta_q - delta_q*||_H / ||H^-1 g||_H [-], infinite where none is known.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)
        Multipliers, the user's own rows last; negative ones are taken as zero.
    """
    if not cone(step.cone).polyhedral:
        return math.inf  # what follows is about rows
    if not (np.isfinite(delta_q).all() and np.isfinite(lam).all()):
        return math.inf
    form = StepForm(step)
    with working_precision(PRECISION):
        x = exact_matrix(delta_q[:, None])
        y = exact_matrix(np.maximum(lam, 0.0)[:, None]) * form.h
        moved = _feasible(step, form, x)
        return math.inf if moved is None else _error(form, x, moved, y)


def _error(form: StepForm, x: arb_mat, moved: arb_mat, y: arb_mat) -> float:
    """The bound from a feasible point that x is moved to, and y >= 0."""
    H = form.H
    free = form.H_inverse * form.g
    way = moved - x
    off = moved - (free + form.H_inverse * (form.A.transpose() * y))
    gap = inner(off, H * off) / 2 + inner(y, form.A * moved + form.c)
    length = square_root(inner(way, H * way)) + square_root(2 * gap)
    unconstrained = square_root(inner(free, H * free))
    return nearest_above(length / unconstrained) if unconstrained > 0 else math.inf


def _feasible(step: StepData, form: StepForm, x: arb_mat) -> arb_mat | None:
    """Return a point x + t v near x that surely satisfies all rows, or None."""
    slack = (form.A * x + form.c).entries()
    if all(s >= 0 for s in slack):
        return x
    direction = opening_direction(step)
    if direction is None:
        return None
    d = exact_matrix(direction[:, None])  # v above
    opening = (form.A * d).entries()
    size = max((-s / o).upper() for s, o in zip(slack, opening, strict=True))
    moved = x + d * size * (1 + arb(2) ** -60)
    return moved if all(s >= 0 for s in (form.A * moved + form.c).entries()) else None


def opening_direction(step: StepData) -> Array | None:
    """A direction v with A v > 0 in every row, shape (n_v,); None if none is found."""
    form = standard_form(step)
    unit = 1 / np.sqrt(np.diag(form.H))
    d = opening(csc_matrix(form.A * unit), np.zeros(len(form.A)), RIDGE)
    return None if d is None else d * unit
