"""Eq. (1), tau_k = K_q delta_q_bar_a. Under test: step.problem.set_values."""

from quasistatic_ref.step.problem import paper_problem, set_values
from tests.closeness import assert_close
from tests.helpers import random_step


def test_the_parameter_tau_k_is_the_stiffness_times_the_desired_change(rng):
    step = random_step(rng, n_a=5)
    problem = paper_problem(step)
    set_values(problem, step)
    tau_k = problem.problem.param_dict["tau_k"].value
    assert_close(tau_k, step.K_q @ step.delta_q_bar_a)
