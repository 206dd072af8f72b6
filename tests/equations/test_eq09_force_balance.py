"""Eq. (9), stationarity, as mended. Under test: certify.residuals.optimality_residuals.

The paper prints [h K_q dq_a - h K_q dq_bar_a + tau_a; M_u / h - h tau_u] + sum_n A_j' lam_j = 0.
(13) implies [h K_q dq_a - h K_q dq_bar_a - h tau_a; M_u dq_u / h - h tau_u] - sum_j A_j' lam_j = 0.
"""

import numpy as np
import pytest

from quasistatic_ref import solve_step
from tests.closeness import assert_relative
from tests.helpers import planted_step, random_step, residuals_of, rows_by_hand
from tests.tolerances import MULTIPLIERS, WRONG


def balance(step, delta_q, lam, *, contact_sign=-1.0, tau_a_factor=None):
    """The left-hand side; the defaults are the mended equation."""
    delta_q_a, delta_q_u = np.split(delta_q, [step.n_a])
    load = (-step.h if tau_a_factor is None else tau_a_factor) * step.tau_a
    left = np.append(
        step.h * step.K_q @ (delta_q_a - step.delta_q_bar_a) + load,
        step.M_u @ delta_q_u / step.h - step.h * step.tau_u,
    )
    return left + contact_sign * lam @ rows_by_hand(step)


def test_the_residual_is_the_largest_entry_of_the_mended_left_hand_side(rng):
    step = random_step(rng)
    delta_q, lam = rng.normal(size=7), rng.normal(size=16)
    actual = residuals_of(step, delta_q, lam).stationarity
    assert_relative(actual, np.abs(balance(step, delta_q, lam)).max())


@pytest.mark.parametrize("contact_sign", [-1.0, 1.0])
@pytest.mark.parametrize("tau_a_factor", [None, 1.0])
def test_erratum_the_optimum_of_13_satisfies_the_mended_equation_alone(
    rng, contact_sign, tau_a_factor
):
    step, _, _ = planted_step(rng)
    answer = solve_step(step)
    slip = {"contact_sign": contact_sign, "tau_a_factor": tau_a_factor}
    residual = balance(step, answer.delta_q, answer.lam, **slip)
    relative = np.abs(residual).max() / np.abs(step.h * step.tau_u).max()
    mended = contact_sign < 0 and tau_a_factor is None
    assert relative < MULTIPLIERS if mended else relative > WRONG


def test_erratum_the_sign_of_tau_a_decides_which_way_a_joint_moves(rng):
    # Without contacts (13) gives delta_q_a = delta_q_bar_a + K_q^-1 tau_a; (9) as printed gives
    # delta_q_bar_a - K_q^-1 tau_a / h.
    step = random_step(rng, n_a=1, n_u=1, rows=()).replace(
        K_q=[[100.0]], tau_a=[1.0], delta_q_bar_a=[0.0]
    )
    assert_relative(solve_step(step).delta_q[0], 1.0 / 100.0, MULTIPLIERS)
