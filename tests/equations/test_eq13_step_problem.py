"""Eq. (13), the quadratic program. Under test: step.problem.paper_problem."""

import numpy as np
import pytest

from quasistatic_ref import standard_form
from tests.closeness import assert_relative
from tests.helpers import planted_step, random_step, slacks
from tests.oracles.printed_rows import problem_at


def objective(step, delta_q):
    """1/2 dq' [h K_q, 0; 0, M_u / h] dq - h [K_q dq_bar_a + tau_a; tau_u]' dq."""
    a, u = np.split(delta_q, [step.n_a])
    energy = step.h * a @ step.K_q @ a + u @ step.M_u @ u / step.h
    pull = step.K_q @ step.delta_q_bar_a + step.tau_a
    return energy / 2 - step.h * (pull @ a + step.tau_u @ u)


@pytest.mark.parametrize(("n_a", "n_u"), [(3, 4), (0, 4), (3, 0), (1, 1)])
def test_the_objective_of_cvxpy_and_of_H_and_g_is_the_printed_one(n_a, n_u, rng):
    step = random_step(rng, n_a, n_u)
    delta_q = rng.normal(size=step.n_v)
    expected = objective(step, delta_q)
    found = problem_at(step, delta_q).problem.objective.value  # over h^3
    assert_relative(found * step.h**3, expected)
    form = standard_form(step)
    assert_relative(0.5 * delta_q @ form.H @ delta_q - form.g @ delta_q, expected)


def test_no_feasible_neighbour_is_better(rng):
    # Needs no optimality condition: only the printed objective and the printed rows.
    step, delta_q, _ = planted_step(rng)
    near = delta_q + 1e-4 * rng.normal(size=(400, step.n_v))
    feasible = [other for other in near if (slacks(step, other) >= 0).all()]
    assert len(feasible) > 10
    assert min(objective(step, other) for other in feasible) > objective(step, delta_q)
