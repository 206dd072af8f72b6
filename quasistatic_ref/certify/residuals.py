"""Residuals of the optimality conditions, Eqs. (9)-(12), in float64, whoever gave the answer.

They prove nothing: a certified step reports them, and only ``certify="residual"`` refuses answers
by them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import check_kind
from quasistatic_ref.numbers.arrays import Array, with_shape
from quasistatic_ref.step.cones import Judge, row_violations
from quasistatic_ref.step.standard_form import StandardForm

LARGE_NUMBER: Final = 2.0**400
"""Numbers from which on sums of products might be infinite, and their difference none."""


@dataclass(frozen=True)
class Residuals:
    """Largest violation of each optimality condition, in the units of the step judged.

    ``optimality_residuals`` makes them; their constructor checks nothing.

    Parameters
    ----------
    stationarity : float
        Eq. :eq:`eq-9`, as mended: H delta_q - g - sum_j A_j' lam_j = 0 [N s, N m s].
    primal : float
        Eq. :eq:`eq-10`: A delta_q >= b [m].
    dual : float
        Eq. :eq:`eq-11`: lam >= 0 [N s].
    complementarity : float
        Eq. :eq:`eq-12`: (A delta_q - b) o lam = 0 [N m s].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.optimality_residuals(qr.standard_form(step), np.zeros(6), np.zeros(step.m)).primal
    0.0
    """

    stationarity: float
    primal: float
    dual: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The largest of the four, NaN if any of them is: for a step in natural units [-]."""
        return largest(np.array([*vars(self).values()]))

    def in_size(self, size: float) -> Residuals:
        """The residuals if delta_q, b, g and lam are measured in another `size` [of theirs]."""
        return Residuals(
            stationarity=self.stationarity / size,
            primal=self.primal / size,
            dual=self.dual / size,
            complementarity=self.complementarity / size / size,
        )


def largest(x: Array) -> float:
    """The largest of the numbers of a vector and 0, in the vector's unit [-]; NaN if one is NaN."""
    return float(x.max(initial=0.0)) + 0.0


def _large_size(*vectors: Array) -> float:
    """A power of two near the largest number, if products with it may be beyond float64; else 1."""
    most = max((float(np.abs(v).max(initial=0.0)) for v in vectors), default=0.0)
    return 2.0 ** (math.frexp(most)[1] - 1) if LARGE_NUMBER < most < math.inf else 1.0


def optimality_residuals(
    form: StandardForm, delta_q: ArrayLike, lam: ArrayLike, judge: Judge = row_violations
) -> Residuals:
    """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at an answer.

    Parameters
    ----------
    form : StandardForm
        The step's H, g, A and b, in SI or in natural units.
    delta_q : array_like, shape (n_v,)
    lam : array_like, shape (m,)
        Multipliers, contact-major, the user's own rows last.
    judge : callable
        (slack, lam) -> how far Eqs. :eq:`eq-10`-:eq:`eq-12` are from holding: of rows, or of
        another cone, whose :meth:`~quasistatic_ref.step.cones.FrictionCone.judge` it is.

    Returns
    -------
    Residuals

    Raises
    ------
    InputError
        If an argument is of another kind.
    StepDataError
        If one has another shape.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> solution = qr.solve_step(step)
    >>> form = qr.standard_form(step)
    >>> qr.optimality_residuals(form, solution.delta_q, solution.lam).worst < 1e-15
    True
    """
    check_kind(form, StandardForm, "form", "a StandardForm, as standard_form(step) returns")
    H, g, A, b = form
    x = with_shape(delta_q, "delta_q", g.shape)
    y = with_shape(lam, "lam", b.shape)
    size = _large_size(x, y)
    with np.errstate(over="ignore"):
        balance = (H @ (x / size) - g / size - A.T @ (y / size)) * size  # Eq. (9), as (13) has it
        slack = (A @ (x / size) - b / size) * size
    short, pull, work = judge(slack, y)  # Eqs. (10)-(12)
    return Residuals(
        stationarity=largest(np.abs(balance)),
        primal=largest(short),
        dual=largest(pull),
        complementarity=largest(np.abs(work)),
    )
