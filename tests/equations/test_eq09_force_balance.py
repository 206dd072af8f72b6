"""Eq. (9), stationarity, as mended. Under test: certify.residuals.optimality_residuals.

The paper prints [h K_q dq_a - h K_q dq_bar_a + tau_a; M_u / h - h tau_u] + sum_n A_j' lam_j = 0.
(13) implies [h K_q dq_a - h K_q dq_bar_a - h tau_a; M_u dq_u / h - h tau_u] - sum_j A_j' lam_j = 0.
"""

import numpy as np
import pytest

from quasistatic_ref import solve_step, standard_form
from quasistatic_ref.certify.residuals import optimality_residuals
from tests.closeness import assert_relative, assert_within
from tests.helpers import contact_row, error, planted_step, random_step
from tests.tolerances import ACTIVE_SET, MULTIPLIERS, ROUNDING, WRONG


def balance(step, delta_q, lam, *, contact_sign=-1.0, tau_a_factor=None):
    """The left-hand side by loops; the defaults are the mended equation."""
    factor = -step.h if tau_a_factor is None else tau_a_factor
    left = []
    for i in range(step.n_a):
        total = factor * step.tau_a[i]
        for k in range(step.n_a):
            total += step.h * step.K_q[i, k] * (delta_q[k] - step.delta_q_bar_a[k])
        left.append(total)
    for i in range(step.n_u):
        total = -step.h * step.tau_u[i]
        for k in range(step.n_u):
            total += step.M_u[i, k] * delta_q[step.n_a + k] / step.h
        left.append(total)
    at = 0
    for j, count in enumerate(step.contacts.rows):
        for i in range(count):
            row = contact_row(step.contacts, j, i)
            for k in range(step.n_v):
                left[k] += contact_sign * row[k] * lam[at]
            at += 1
    return np.array(left)


def relative(step, residual):
    """The residual against the impulses that balance in it."""
    return np.abs(residual).max() / np.abs(step.h * step.tau_u).max()


@pytest.mark.parametrize("seed", range(2))
def test_the_residual_is_the_largest_entry_of_the_mended_left_hand_side(seed):
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    delta_q = rng.normal(size=7)
    lam = rng.normal(size=16)
    expected = max(abs(entry) for entry in balance(step, delta_q, lam))
    actual = optimality_residuals(standard_form(step), delta_q, lam).stationarity
    assert_relative(actual, expected, ROUNDING)


@pytest.mark.parametrize("seed", range(2))
def test_a_step_planted_by_the_mended_equation_is_solved_by_its_plant(seed):
    step, delta_q, lam = planted_step(np.random.default_rng(seed))
    assert relative(step, balance(step, delta_q, lam)) < ROUNDING
    assert_within(error(step, solve_step(step).delta_q, delta_q), 0.0, ACTIVE_SET)


@pytest.mark.parametrize("seed", range(2))
def test_erratum_the_optimum_of_13_satisfies_the_mended_equation(seed):
    step, _, _ = planted_step(np.random.default_rng(seed))
    optimum = solve_step(step)
    assert relative(step, balance(step, optimum.delta_q, optimum.lam)) < MULTIPLIERS


@pytest.mark.parametrize(
    "slip",
    [{"contact_sign": 1.0}, {"tau_a_factor": 1.0}, {"contact_sign": 1.0, "tau_a_factor": 1.0}],
)
@pytest.mark.parametrize("seed", range(2))
def test_erratum_the_optimum_of_13_violates_the_printed_equation(seed, slip):
    step, _, _ = planted_step(np.random.default_rng(seed))
    optimum = solve_step(step)
    assert relative(step, balance(step, optimum.delta_q, optimum.lam, **slip)) > WRONG


def test_erratum_the_sign_of_tau_a_decides_which_way_a_joint_moves(rng):
    # Without contacts (13) gives delta_q_a = delta_q_bar_a + K_q^-1 tau_a; (9) as printed gives
    # delta_q_bar_a - K_q^-1 tau_a / h.
    step = random_step(rng, n_a=1, n_u=1, rows=()).replace(
        K_q=[[100.0]], tau_a=[1.0], delta_q_bar_a=[0.0]
    )
    assert_relative(solve_step(step).delta_q[0], 1.0 / 100.0, MULTIPLIERS)


def test_erratum_M_u_over_h_without_delta_q_u_is_a_matrix_and_no_force(rng):
    step = random_step(rng, n_u=4)
    assert (step.M_u / step.h).shape == (4, 4)
    assert (step.h * step.tau_u).shape == (4,)
