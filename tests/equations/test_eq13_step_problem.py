"""Eq. (13), the quadratic program. Under test: step.problem.StepProblem."""

import numpy as np
import pytest

from quasistatic_ref import StepProblem, standard_form
from tests.closeness import assert_relative
from tests.helpers import planted_step, random_step, slacks
from tests.tolerances import ROUNDING


def objective(step, delta_q):
    """1/2 dq' [h K_q, 0; 0, M_u / h] dq - h [K_q dq_bar_a + tau_a; tau_u]' dq, by loops."""
    n_a = step.n_a
    value = 0.0
    for i in range(n_a):
        pull = step.tau_a[i]
        for k in range(n_a):
            value += 0.5 * step.h * step.K_q[i, k] * delta_q[i] * delta_q[k]
            pull += step.K_q[i, k] * step.delta_q_bar_a[k]
        value -= step.h * pull * delta_q[i]
    for i in range(step.n_u):
        for k in range(step.n_u):
            value += 0.5 / step.h * step.M_u[i, k] * delta_q[n_a + i] * delta_q[n_a + k]
        value -= step.h * step.tau_u[i] * delta_q[n_a + i]
    return value


@pytest.mark.parametrize(("n_a", "n_u"), [(3, 4), (0, 4), (3, 0), (1, 1)])
def test_the_cvxpy_objective_is_the_printed_one(n_a, n_u, rng):
    step = random_step(rng, n_a, n_u)
    problem = StepProblem(step)
    problem.fill(step)
    for _ in range(5):
        delta_q = rng.normal(size=step.n_v)
        problem.delta_q_a.value = delta_q[:n_a]
        problem.delta_q_u.value = delta_q[n_a:]
        assert_relative(problem.problem.objective.value, objective(step, delta_q), ROUNDING)


def test_H_and_g_give_the_printed_objective(rng):
    step = random_step(rng)
    form = standard_form(step)
    for _ in range(5):
        delta_q = rng.normal(size=step.n_v)
        actual = 0.5 * delta_q @ form.H @ delta_q - form.g @ delta_q
        assert_relative(actual, objective(step, delta_q), ROUNDING)


@pytest.mark.parametrize("seed", range(2))
def test_no_feasible_neighbour_is_better(seed):
    # Needs no optimality condition: only the printed objective and the printed rows.
    rng = np.random.default_rng(seed)
    step, delta_q, _ = planted_step(rng)
    best = objective(step, delta_q)
    compared = 0
    for _ in range(400):
        other = delta_q + 1e-4 * rng.normal(size=step.n_v)
        if (slacks(step, other) >= 0).all():
            compared += 1
            assert objective(step, other) > best
    assert compared > 10
