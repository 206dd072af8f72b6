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

from dataclasses import dataclass

import numpy as np
from flint import arb, arb_mat, ctx, fmpq

from quasistatic_ref.certify.minimiser import (
    PRECISION,
    BallForm,
    form_in_balls,
    inner,
    square_root,
)
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rounding import nearest_above
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

ROUNDS = 100
"""Corrections of the direction; most steps need fewer than ten."""


@dataclass(frozen=True)
class ErrorBound:
    """How far an answer is from the optimum, at most.

    Parameters
    ----------
    gap : float
        1/2 ||delta_q - delta_q*||_H^2 <= gap, infinite if unknown [N m s]; the distance to a
        feasible point is in it, so that it is no duality gap where delta_q is infeasible.
    error : float
        ||delta_q - delta_q*||_H / ||H^-1 g||_H <= error [-]; infinite if unknown.
    """

    gap: float
    error: float


UNKNOWN = ErrorBound(float("inf"), float("inf"))


def error_bound(step: StepData, delta_q: Array, lam: Array) -> ErrorBound:
    """A rigorous bound of the error of an answer.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)
        Multipliers, the user's own rows last; negative ones are taken as zero.

    Returns
    -------
    ErrorBound
    """
    if not cone(step.cone).polyhedral:
        return UNKNOWN  # what follows is about rows
    if not (np.isfinite(delta_q).all() and np.isfinite(lam).all()):
        return UNKNOWN
    form = exact_form(step)
    balls = form_in_balls(form)
    with ctx.workprec(PRECISION):
        x = _column(delta_q, form.x_unit)
        y = _column(np.maximum(lam, 0.0), form.lam_unit)
        moved = _feasible(step, form, balls, x)
        if moved is None:
            return UNKNOWN
        length, error = _distance(form, balls, x, moved, y)
        energy = arb(form.net_unit * form.x_unit)
        return ErrorBound(nearest_above(energy * length * length / 2), error)


def _distance(
    form: ExactForm, balls: BallForm, x: arb_mat, moved: arb_mat, y: arb_mat
) -> tuple[arb, float]:
    """Bounds of ||x - x*||_H and of the relative error, from a feasible point and y >= 0."""
    H = arb_mat(form.H)
    way = moved - x
    off = moved - (balls.x_free + balls.H_inv * (balls.A.transpose() * y))
    gap = inner(off, H * off) / 2 + inner(y, balls.A * moved - balls.b)
    length = square_root(inner(way, H * way)) + square_root(2 * gap)
    free = square_root(inner(balls.x_free, H * balls.x_free))
    return length, nearest_above(length / free) if free > 0 else float("inf")


def _feasible(step: StepData, form: ExactForm, balls: BallForm, x: arb_mat) -> arb_mat | None:
    """Return a point x + t v near x that surely satisfies all rows, or None."""
    slack = (balls.A * x - balls.b).entries()
    if all(s >= 0 for s in slack):
        return x
    direction = opening_direction(step)
    if direction is None:
        return None
    d = _column(direction, form.x_unit)  # v above
    opening = (balls.A * d).entries()
    size = max((-s / o).upper() for s, o in zip(slack, opening, strict=True))
    moved = x + d * size * (1 + arb(2) ** -60)
    return moved if all(s >= 0 for s in (balls.A * moved - balls.b).entries()) else None


def opening_direction(step: StepData) -> Array | None:
    """A strictly feasible direction v, A v > 0 in every row; None if none is found.

    Parameters
    ----------
    step : StepData

    Returns
    -------
    ndarray, shape (n_v,), or None
    """
    form = standard_form(step)
    unit = 1 / np.sqrt(np.diag(form.H))
    A = form.A * unit
    norms = np.linalg.norm(A, axis=1)
    if not norms.all():
        return None
    A = A / norms[:, None]
    inverse = np.linalg.pinv(A)
    d = np.zeros(A.shape[1])
    # Alternating projections of z = A d (d is the v above) to {z >= 1} and to the range of A:
    # Cheney and Goldstein (1959).
    for _ in range(ROUNDS):
        short = np.maximum(1 - A @ d, 0)
        if short.max(initial=0.0) < 0.5:
            return d * unit
        d = d + inverse @ short
    return None


def _column(values: Array, unit: fmpq) -> arb_mat:
    return arb_mat([[arb(float(v)) / unit] for v in values]) if len(values) else arb_mat(0, 1)
