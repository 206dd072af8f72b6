r"""The bound of the error of an answer in float64 alone, with a bound of its own rounding added.

The bound is that of :mod:`~quasistatic_ref.optional.large.bound`, for the common case in which
float64 suffices: with a direction v, A v > 0, x' = x + t v is feasible, and

.. math:: \|x - x^*\|_H \le t\,\|v\|_H
          + \big((\|r\|_{H^{-1}} + t\,\|v\|_H)^2 + 2\,y^T(A x' - b)\big)^{1/2},
          \qquad r = H x - g - A^T y.

H, g and A are those that the step's numbers give without rounding. The rounding of a sum, in
whatever order it is taken, is at most a certain multiple of u = 2^-53 times the sum of the absolute
values of its terms. The documentation derives these multiples on the page of exact answers.
"""

import math
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, ctx

from quasistatic_ref.certify.minimiser import PRECISION
from quasistatic_ref.optional.large.bound import opening_direction
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm

U = 2.0**-53
"""Largest relative error of one operation."""

EXTRA_SLACK, EXTRA_BALANCE, EXTRA_TRANSPOSE, EXTRA_ENERGY = 8, 4, 8, 8
"""Roundings of A x - b, H x - g, A'y and ||H^-1 g||^2 in addition to n, n, k and 4 n of them, for n
coordinates and k positive multipliers."""

MORE = 1 + 2.0**-30
"""Covers the rounding of the bounds themselves, sums of up to 2^20 numbers that are not negative,
and the relative rounding u of a slack."""

UNDERFLOW = 2.0**-500
"""More than products lose below the range of float64, if all units are in RANGE."""

RANGE = 2.0**-100, 2.0**100


class Rounded(NamedTuple):
    """An answer in natural units, with bounds of how far rounding has moved its sums.

    Parameters
    ----------
    x, y : ndarray, shapes (n_v,) and (m,)
        The answer, y >= 0 [-].
    reach : ndarray, shape (n_c, n_v)
        For the rows of A of each contact, an upper bound of the sums of the absolute values of the
        terms of each entry [-].
    slack, balance : ndarray, shapes (m,) and (n_v,)
        A x - b and H x - g - A'y in float64 [-].
    off_slack : float
        Bound of the error of each slack, apart from u times its absolute value [-].
    off_balance : ndarray, shape (n_v,)
        Bound of the error of each entry of the balance [-].
    load : ndarray, shape (n_v,)
        Upper bound of |g|, and of the sums of the absolute values of the terms of g [-].
    """

    x: Array
    y: Array
    reach: Array
    slack: Array
    balance: Array
    off_slack: float
    off_balance: Array
    load: Array


class FloatBound:
    """Bounds for steps of one H in the same units of coordinates, in natural units.

    Parameters
    ----------
    inverse_in_balls : arb_mat, shape (n_v, n_v)
        (h H)^-1 of the steps.
    h : arb
        Their time step [s].
    H : ndarray, shape (n_v, n_v)
        In natural units [-].
    coordinate : ndarray, shape (n_v,)
        Diagonal of S of the natural units [m or rad, per (N m s)^0.5].

    Attributes
    ----------
    sizes : ndarray, shape (n_v, n_v)
        Absolute values of H.
    inverse, magnitude : ndarray, shape (n_v, n_v)
        H^-1 in float64, and M >= |H^-1| with |inverse - H^-1| <= 2 u M.
    """

    def __init__(self, inverse_in_balls: arb_mat, h: arb, H: Array, coordinate: Array) -> None:
        self.inverse_in_balls = inverse_in_balls
        self.coordinate = coordinate
        self.sizes = np.abs(H)
        S = coordinate.tolist()
        n = len(coordinate)
        with ctx.workprec(PRECISION):
            entries = (inverse_in_balls * h).entries()
            balls = [v / arb(S[i // n]) / S[i % n] for i, v in enumerate(entries)]
            above = [float(v.abs_upper() + v.rad() * 2.0**54) for v in balls]
        self.inverse = np.array([float(v.mid()) for v in balls]).reshape(n, n)
        self.magnitude = MORE * np.array(above).reshape(n, n)
        self.in_range = all(RANGE[0] < unit < RANGE[1] for unit in (float(h), *S))
        self._opening: tuple[Array, float] | None = None
        self._mu = self._weight = np.zeros(0)

    def serves(self, inverse_in_balls: arb_mat, coordinate: Array) -> bool:
        """Whether it is for this H in units `coordinate`, (n_v,) [m or rad, per (N m s)^0.5]."""
        return inverse_in_balls is self.inverse_in_balls and coordinate is self.coordinate

    def error(
        self, step: StepData, form: StandardForm, units: tuple[float, float], x: Array, lam: Array
    ) -> float | None:
        """Bound of ||x - x*||_H / ||H^-1 g||_H [-]; None where nothing is decided.

        Parameters
        ----------
        step : StepData
            In a polyhedral cone.
        form : StandardForm
            In natural units [-].
        units : (float, float)
            ell [m per (N m s)^0.5] and rho [(N m s)^0.5] of these.
        x, lam : ndarray, shapes (n_v,) and (m,)
            In natural units [-]; multipliers below zero are taken as zero.
        """
        usable = self.in_range and all(RANGE[0] < unit < RANGE[1] for unit in units)
        if not usable or step.extra.names:
            return None
        at = self.rounded(step, form, units, x, np.maximum(lam, 0.0))
        moved = self.moved(step, form, at)
        free = self.energy(form.g, at.load)
        if moved is None or not free > 0:
            return None
        way, work = moved
        rest = np.abs(at.balance) + at.off_balance
        unbalanced = math.sqrt(float(rest.dot(self.magnitude).dot(rest)))
        length = way + math.sqrt((unbalanced + way) ** 2 + 2 * work)
        error = MORE * length / math.sqrt(free)
        return error if math.isfinite(error) else None

    def rounded(
        self, step: StepData, form: StandardForm, units: tuple[float, float], x: Array, y: Array
    ) -> Rounded:
        """The sums of the bound for an answer, and how far rounding may have moved them.

        Parameters
        ----------
        step, form, x
            As in :meth:`error`.
        units : (float, float)
            As there: [m per (N m s)^0.5] and [(N m s)^0.5].
        y : ndarray, shape (m,)
            Multipliers, none of them below zero [-].
        """
        (n,) = x.shape
        ell, rho = units
        contacts = step.contacts
        reach = np.einsum("cij,ci->cj", np.abs(contacts.J), self.weight(contacts.mu))
        reach *= self.coordinate / ell
        target = np.abs(step.delta_q_bar_a) / (rho * self.coordinate[: step.n_a])
        load = np.abs(form.g) + 2 * self.sizes[:, : step.n_a].dot(target) + UNDERFLOW
        size = np.abs(x)
        lost = U * UNDERFLOW
        balance = form.H.dot(x) - form.g - form.A.T.dot(y)
        sums = (n + EXTRA_BALANCE) * (self.sizes.dot(size) + load) + np.abs(balance)
        slack = form.A.dot(x) - form.b
        off_slack = 0.0
        if y.size:
            lost *= 1 + float(size.sum() + y.sum())
            off_slack = U * (n + EXTRA_SLACK) * float(reach.dot(size).max()) + lost
            of_contacts = np.add.reduceat(y, step.offsets[:-1])
            sums += (np.count_nonzero(y) + EXTRA_TRANSPOSE) * of_contacts.dot(reach)
        return Rounded(x, y, reach, slack, balance, off_slack, U * sums + lost, load)

    def weight(self, mu: Array) -> Array:
        """The largest factor of each row of J in a row of A, shape (n_c, 4), for a `mu`."""
        if mu is not self._mu:
            sliding = 1 + mu[:, :1]
            self._weight = np.hstack([sliding, sliding, sliding, mu[:, 2:]])
            self._mu = mu
        return self._weight

    def energy(self, g: Array, load: Array) -> float:
        """A lower bound of ||H^-1 g||_H^2 in natural units [-], for g and its `load`, (n_v,)."""
        off = U * (4 * len(g) + EXTRA_ENERGY) * float(load.dot(self.magnitude).dot(load))
        return float(g.dot(self.inverse).dot(g)) - MORE * off

    def moved(self, step: StepData, form: StandardForm, at: Rounded) -> tuple[float, float] | None:
        """Bounds of t ||v||_H and y'(A x' - b) [-]; None if no v with A v > 0 is found."""
        if not at.y.size:
            return 0.0, 0.0
        for again in (False, True):
            found = self.opening(step, again)
            if found is None:
                return None
            d, length = found  # v above, and its length
            opened = form.A.dot(d)
            off = U * (len(d) + EXTRA_SLACK) * float(at.reach.dot(np.abs(d)).max()) + UNDERFLOW
            least = float(opened.min()) - off
            if least > off:
                t = (at.off_slack - min(float(at.slack.min()), 0.0)) / least
                work = float(at.y.dot(np.maximum(at.slack, 0.0))) + t * float(at.y.dot(opened))
                return t * length, work + (at.off_slack + t * off) * float(at.y.sum())
        return None

    def opening(self, step: StepData, again: bool) -> tuple[Array, float] | None:
        """The kept v in natural units, (n_v,), or `again` a new one; and a bound of ||v||_H."""
        if again or self._opening is None:
            d = opening_direction(step)
            if d is None:
                return None
            d = d / self.coordinate
            square = float(np.abs(d) @ self.sizes @ np.abs(d))
            self._opening = d, MORE * math.sqrt(square)
        return self._opening
