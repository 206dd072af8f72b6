r"""The smoothed step: every row replaced by a logarithmic barrier, and how its answer changes.

.. math:: \min_x \tfrac12 x^T H x - g^T x - \kappa \sum_i \log(a_i x - b_i)

Its minimiser is unique, strictly inside of all rows, and a smooth function of the data. Each row
pushes with :math:`\lambda_i = \kappa / s_i`, whatever its slack :math:`s_i` is. With rates of the
data at fixed x and :math:`\lambda`, (R36):

.. math:: (H + A^T S\,A)\,dx = d(g - Hx) + dA^T\lambda - A^T S\,(dA\,x - db), \qquad
          S = \mathrm{diag}(\lambda_i / s_i) .
"""

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.form import exact_matrix
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import impulses
from quasistatic_ref.step.standard_form import standard_form

STEPS = 200
"""Most Newton steps; twenty are usual."""

SHORTEN = 0.99
"""Share of the way that a Newton step may take, until the first slack or multiplier is zero."""

NOTHING = 1e-200
"""Newton's step in the H norm at which the method is done if nothing moves [(N m s)^0.5]."""

SETTLED = 1e-14
"""Newton's step over the displacement, in the H norm, at which the method is done [-]: rounding."""

LEAST_BITS, MOST_BITS = 256, 4096
"""Precisions at which the rates are solved for [bits]: weights are up to 1 / kappa apart."""


class Barrier(NamedTuple):
    """The minimiser.

    Parameters
    ----------
    x : ndarray, shape (n_v,)
        delta_q [m, rad].
    lam, slack : ndarray, shape (m,)
        kappa / s [N s], and s = A x - b [m], both positive.
    """

    x: Array
    lam: Array
    slack: Array


def barrier_step(step: StepData, kappa: float) -> Barrier:
    """The minimiser of a step with barriers, by a primal-dual Newton method.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    kappa : float
        [N m s], > 0.

    Returns
    -------
    Barrier

    Raises
    ------
    StepNotSolved
        If there is no displacement strictly inside of all rows, as far as the method can tell.
    """
    with np.errstate(all="ignore"):  # numbers that leave their range end the method
        barrier = _newton(*standard_form(step), kappa)
    if barrier is None:
        raise StepNotSolved("barrier", "nothing lies strictly inside of all rows", step, kappa)
    return barrier


def _newton(H: Array, g: Array, A: Array, b: Array, kappa: float) -> Barrier | None:
    L = np.linalg.cholesky(H)
    x = np.linalg.solve(H, g)
    initial_slack = float(np.abs(A @ x - b).max(initial=0.0)) + kappa**0.5
    slack = np.full(len(b), initial_slack)
    mu = max(kappa, initial_slack * float(np.abs(L.T @ x).max(initial=0.0)))
    lam = mu / slack
    least = np.inf
    size = 0.0
    nearest = None
    for _ in range(STEPS):
        mu = max(kappa, 0.1 * float(lam @ slack) / max(len(lam), 1))
        off = g + A.T @ lam - H @ x
        short = b + slack - A @ x
        weight = lam / slack
        push = mu / slack - lam
        K = H + A.T @ (weight[:, None] * A)
        if not np.isfinite(K).all():
            break
        dx = np.linalg.lstsq(K, off + A.T @ (push + weight * short), rcond=None)[0]
        d_slack = A @ dx - short
        d_lam = push - weight * d_slack
        share = min(_share(slack, d_slack), _share(lam, d_lam))
        x = x + share * dx
        slack = slack + share * d_slack
        lam = lam + share * d_lam
        length = float(np.linalg.norm(L.T @ dx))
        size = float(np.linalg.norm(L.T @ x))
        if mu == kappa and share == 1 and length < least:  # after a whole step s = A x - b
            least = length
            nearest = Barrier(x, lam, slack)
        if least <= SETTLED * size + NOTHING:
            break
    return nearest if least <= 1e5 * SETTLED * size + NOTHING else None


def _share(values: Array, changes: Array) -> float:
    falling = changes < 0
    until = (-values[falling] / changes[falling]).min(initial=np.inf)
    return float(min(1.0, SHORTEN * until))


def barrier_rates(step: StepData, barrier: Barrier, data: DataRates) -> Array:
    """How the minimiser changes with P parameters, shape (n_v, P) [m, rad per unit].

    Parameters
    ----------
    step : StepData
    barrier : Barrier
    data : DataRates
        At the minimiser.

    Raises
    ------
    InputError
        If kappa is so small that nothing is known of them.
    """
    form = standard_form(step)
    table = cone_matrix(step.cone)
    multipliers = impulses(step.contacts, barrier.lam, step.cone) @ table
    moved = (table @ data.motion)[step.mask]
    pushed = data.load + data.pull(multipliers)
    return _weighted_solution(form.H, form.A, barrier, pushed, moved)


def _weighted_solution(H: Array, A: Array, barrier: Barrier, pushed: Array, moved: Array) -> Array:
    """(H + A'SA)^-1 (pushed - A'S moved), shape (n_v, P), with a bound of the error of the solve.

    S grows as 1 / kappa: float64 loses the whole of H next to A'SA. So the numbers are balls, at a
    precision at which what is left of them is the rounding of the result.
    """
    if not pushed.size:
        return pushed.copy()
    precision = LEAST_BITS
    while precision <= MOST_BITS:
        with working_precision(precision):
            rows = exact_matrix(A)
            slack, lam = (list(map(arb, v.tolist())) for v in (barrier.slack, barrier.lam))
            weighted = rows.transpose() * _diagonal(
                [y / s for y, s in zip(lam, slack, strict=True)]
            )
            right = exact_matrix(pushed) - weighted * exact_matrix(moved)
            try:
                solution = (exact_matrix(H) + weighted * rows).solve(right)
            except ZeroDivisionError:  # the balls hold a singular matrix, too
                precision *= 2
                continue
        middle = np.array([float(v.mid()) for v in solution.entries()])
        radius = np.array([float(v.rad()) for v in solution.entries()])
        if (radius <= SETTLED * np.abs(middle).max(initial=0.0)).all():
            return middle.reshape(pushed.shape)
        precision *= 2
    raise InputError(
        "is so small that the derivatives are not known to any digit; take a larger one",
        field="kappa",
        value=float(barrier.lam.max() * barrier.slack.min()),
    )


def _diagonal(values: list[arb]) -> arb_mat:
    """A diagonal matrix."""
    matrix = arb_mat(len(values), len(values))
    for i, value in enumerate(values):
        matrix[i, i] = value
    return matrix
