r"""Eq. :eq:`eq-13` as the matrices H, g, A, b that solvers see.

.. math:: \min_{\delta q} \tfrac12 \delta q^T H \delta q - g^T \delta q
          \quad\text{s.t.}\quad A\,\delta q \ge b
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.friction import friction_rows, row_constants


class StandardForm(NamedTuple):
    """The quadratic program of one step, in float64.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
        Positive definite; block diagonal, unless a user's cost couples the blocks.
    g : ndarray, shape (n_v,)
    A : ndarray, shape (m, n_v)
        Contact-major; the user's extra rows come last. A contact in the ellipsoid has four rows,
        J_n, J_1, J_2 and J_w: A delta_q - b is (gap, sliding along d1 and d2, rotation about n).
    b : ndarray, shape (m,)
    """

    H: Array
    g: Array
    A: Array
    b: Array


def standard_form(step: StepData) -> StandardForm:
    """H, g of Eq. :eq:`eq-13` and A, b of Eq. :eq:`eq-8`, stacked over the contacts.

    Parameters
    ----------
    step : StepData

    Returns
    -------
    StandardForm

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> form = qr.standard_form(step)
    >>> form.H.shape, form.A.shape
    ((6, 6), (6, 6))
    """
    check_step(step)
    A, b = inequalities(step)
    return StandardForm(step.H, linear_term(step), A, b)


def inequalities(step: StepData) -> tuple[Array, Array]:
    """A, shape (m, n_v), and b, shape (m,), of Eq. :eq:`eq-8` and of the user's rows."""
    mask = step.mask
    A = friction_rows(step.contacts, step.cone)[mask]  # Eq. (8)
    b = -row_constants(step.contacts, step.cone)[mask]  # Eq. (8)
    if step.extra.names:
        A = np.concatenate([A, step.extra.A])
        b = np.concatenate([b, step.extra.b])
    return A, b


def linear_term(step: StepData) -> Array:
    """The linear term g of Eq. :eq:`eq-13` and of a user's cost, (n_v,) [N s, N m s]."""
    tau_k = product(step.K_q, step.delta_q_bar_a)  # Eq. (1)
    g: Array = step.h * np.concatenate([tau_k + step.tau_a, step.tau_u])
    cost = step.extra.cost
    return g if cost is None else g + cost[1]
