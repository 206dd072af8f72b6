"""Eq. (1), tau_k = K_q delta_q_bar_a. Under test: step.problem.StepProblem."""

import numpy as np

from quasistatic_ref import StepProblem, standard_form
from tests.closeness import assert_close
from tests.helpers import random_step
from tests.tolerances import ROUNDING


def tau_k(step):
    force = []
    for i in range(step.n_a):
        total = 0.0
        for j in range(step.n_a):
            total += step.K_q[i, j] * step.delta_q_bar_a[j]
        force.append(total)
    return force


def test_the_parameter_tau_k_is_the_stiffness_times_the_desired_change(rng):
    step = random_step(rng, n_a=5)
    problem = StepProblem(step)
    problem.fill(step)
    found = problem.problem.param_dict["tau_k"].value
    assert_close(found, tau_k(step), ROUNDING)


def test_g_holds_h_times_tau_k_where_no_other_force_acts(rng):
    step = random_step(rng, n_a=5).replace(tau_a=np.zeros(5))
    expected = [step.h * force for force in tau_k(step)]
    np.testing.assert_allclose(
        standard_form(step).g[:5], expected, rtol=ROUNDING, atol=ROUNDING * step.h
    )
