"""Zeros that no ball shows: those that a working set implies, and those that its loads leave."""

import numpy as np
import pytest

from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast.compiled import compiled
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.optional.fast.guess.zeros import Degeneracy, zeros
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.step.data import Extra
from tests.certify.test_exact import resting_point
from tests.helpers import changed
from validation.make.confirmed_bits import differing, proof

SPINS, SLIPS = [4, 5], [0, 1, 2, 3]
"""Rows of a contact. Both of its spins hold its gap and its spin."""


@pytest.mark.parametrize("name", ["sphere_spin", "two_finger_pinch", "block_incline"])
def test_what_loads_leave_at_rest_is_proved_with_the_same_bits(name):
    run = load_scenario(name, ["steps=12", "solver.backend=none"], fast=True).run(progress=False)
    for k in range(2, run.steps, 3):
        step = run.step_data(k)
        form = exact_form(step)
        guess = form_optimum(form).working_set
        truth = form_optimum(form, guess)
        answers = [BallStep(step, BallHessian(step)).confirmed(guess)]
        if compiled("certificate") is not None:
            answers.append(proof(step, np.array(guess, dtype=np.int64)))
        for answer in answers:
            assert isinstance(answer, ExactOptimum)
            assert differing(answer, truth) == []


def test_what_is_not_pushed_stays_and_a_pair_of_slips_is_strictly_active():
    unloaded = resting_point()
    pushed = resting_point(tau_x=0.1)
    several = Degeneracy(unique=False, smooth=True)
    one = Degeneracy(unique=True, smooth=True)
    assert zeros(unloaded, SPINS, SLIPS, [0, 1, 2, 3]) == several
    assert zeros(unloaded, SPINS, [0, 2], [0]) == several  # their sum is twice the gap
    assert zeros(pushed, SPINS, SLIPS, []) is None  # it slides along x
    assert zeros(pushed, SPINS, [], [0]) is None
    assert zeros(pushed, SPINS, [], [1, 2, 3]) == one
    assert zeros(pushed, SPINS, [1, 3], [1, 2, 3]) == several


def test_a_row_without_slack_that_nothing_presses_on_is_a_kink():
    step = resting_point()
    assert zeros(step, SPINS, [0], []) == Degeneracy(unique=True, smooth=False)
    weightless = resting_point(weight=0.0)
    every = Degeneracy(unique=True, smooth=False)  # the gap falls along no combination of rows
    assert zeros(weightless, [], [0, 1, 2, 3, 4, 5], []) == every
    assert zeros(weightless, [], [], [0, 1, 2, 3]) == Degeneracy(unique=True, smooth=True)
    truth = form_optimum(exact_form(weightless))
    assert (truth.multipliers_unique, truth.differentiable) == every[:2]


def test_the_same_rows_of_another_contact_are_another_claim():
    """Where the contact's point moves along n alone, its slips n + d1 are its gap."""
    free = resting_point()
    J = free.contacts.J.copy()
    J[:, :2] = 0.0
    held = free.replace(contacts=changed(free.contacts, J=J))
    assert zeros(held, SPINS, [0], []).implied
    assert not zeros(free, SPINS, [0], []).implied


def test_the_same_numbers_in_another_shape_are_another_claim():
    """In x >= 1, x >= 1 the first row implies the second; in x + y >= 1, 5 x + y >= 3 it does not.

    Both optima have no slack there, the second, (1/2, 1/2), because of its loads.
    """
    implied = own_rows_alone([[1], [1], [5]], [1, 1, 3])
    loaded = own_rows_alone([[1, 1], [5, 1]], [1, 3])
    assert zeros(implied, [0], [1], []) == Degeneracy(unique=False, smooth=True, implied=True)
    assert zeros(loaded, [0], [1], []) == Degeneracy(unique=True, smooth=False)


def own_rows_alone(A, b):
    """A step without contacts or loads."""
    n = len(A[0])
    none = contacts_of(np.zeros(0), np.zeros((0, 3, 3)), np.zeros((0, 4, n)), 0.0)
    own = Extra(tuple(f"row {i}" for i in range(len(b))), np.array(A), np.array(b))
    return free_step(np.eye(n), np.zeros(n), none, 0.01).replace(extra=own)
