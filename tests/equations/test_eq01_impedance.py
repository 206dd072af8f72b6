"""Eq. (1), tau_k = K_q delta_q_bar_a. Under test: step.standard_form.spring_load."""

import numpy as np

from tests.closeness import assert_close
from tests.helpers import random_step
from tests.oracles.printed_rows import problem_at


def test_the_parameter_tau_k_is_the_stiffness_times_the_desired_change(rng):
    step = random_step(rng, n_a=5)
    page = problem_at(step, np.zeros(step.n_v))
    assert_close(page.parameters["tau_k"].value, step.K_q @ step.delta_q_bar_a)
