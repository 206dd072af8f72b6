"""The one definition of error, on a step whose H is a multiple of the identity."""

import math

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import Extra, StepData
from quasistatic_ref.certify.norm import correct_digits, energy_norm, error_length, single_loads
from quasistatic_ref.exact.digits import digits_of_error
from tests.closeness import assert_relative, assert_within
from tests.helpers import EAST, point_between_walls
from tests.made import Z, actuated_step, contacts_of, frames_about, no_contacts

HALF_DIGIT = 0.5
"""Rounding in the norms moves a digit count by far less."""


@pytest.mark.parametrize(
    ("error", "digits"),
    [(0.0, 16.0), (1e-20, 16.0), (1e-7, 7.0), (1.0, 0.0), (5.0, 0.0), (math.nan, 0.0)],
)
def test_digits_are_clipped(error, digits):
    assert_within(digits_of_error(error), digits)


def test_errors_of_idle_steps_are_measured_by_a_micrometre():
    step = point_between_walls([EAST], [1.0])
    zero = np.zeros(3)
    assert correct_digits(step, zero, zero) == 16.0
    assert correct_digits(step, np.array([1e-14, 0, 0]), zero) == pytest.approx(8, abs=HALF_DIGIT)
    assert correct_digits(step, np.array([1e-5, 0, 0]), zero) == 0.0


def waiting_pusher():
    """A spring at its target, 0.5 mm in front of a puck; g = 0."""
    J = np.zeros((1, 4, 4))
    J[0, :2] = [-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -0.05]
    contacts = contacts_of([5e-4], frames_about(np.array([EAST]), -Z), J, 0.3)
    none = np.zeros(1)
    return StepData(0.01, [[1000.0]], np.diag([0.5, 0.5, 1e-3]), none, np.zeros(3), none, contacts)


def arm_at_rest():
    """Springs that bear a load, far from a limit: K_q delta_q_bar_a + tau_a is rounding."""
    K_q = np.diag([100.0, 50.0])
    tau = np.array([-3.1, -0.7])
    rests = actuated_step(K_q, tau, np.linalg.solve(K_q, -tau), no_contacts(2), 0.01)
    limit = Extra(("limit",), [[1.0, 0.0]], [-1.0])
    return rests.replace(tau_a=tau * (1 + 2e-16), extra=limit)


def pushed_out():
    """A ball that overlaps a wall by 0.1 mm, without a load."""
    return point_between_walls([EAST], [-1e-4])


@pytest.mark.parametrize("backend", ["clarabel", "piqp", "daqp", "osqp"])
@pytest.mark.parametrize("idle", [waiting_pusher, arm_at_rest, pushed_out])
def test_right_answers_of_idle_steps_have_digits(idle, backend):
    assert qr.solve_step(idle(), backend).statistics.digits >= 8


def test_a_limit_that_is_far_away_lends_no_digits():
    step = point_between_walls([EAST], [1.0], force=(0.0, 3.0, 4.0))
    exact = qr.solve_step(step).delta_q
    far = step.replace(extra=Extra(("far",), [[0.0, 1.0, 0.0]], [-1e6]))
    off = exact * (1 + 1e-5)
    assert correct_digits(far, off, exact) == correct_digits(step, off, exact)
    assert correct_digits(step, off, exact) == pytest.approx(5, abs=HALF_DIGIT)


@pytest.mark.parametrize("scene", ["block_push", "two_finger_pinch", "stack"])
def test_driven_steps_are_measured_by_the_unconstrained_step(scene):
    run = qr.load_scenario(scene, record="full", steps=4).run()
    for k, delta_q in enumerate(run["delta_q"]):
        step = run.step_data(k)
        norm = energy_norm(step.H)
        g = qr.standard_form(step).g
        length = error_length(step.H, g, delta_q, single_loads(step))
        assert_relative(length, norm.of_impulse(g))


def test_a_micrometre_is_one_of_the_softest_coordinate():
    """1e-6 m is 2e-6 (N m s)^0.5 where H is 4, and 1e-3 where it is 1e6."""
    zero = np.zeros(2)
    assert_relative(error_length(np.diag([1e6, 4.0]), zero, zero), 2e-6)
