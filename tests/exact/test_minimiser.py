"""The proof of a right guess: what float64 claims is true, and every sign and rounding is exact."""

import itertools

import numpy as np
import pytest

from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import implied, independent_rows
from quasistatic_ref.exact.working_set import UpdatedInverse, ball_point
from tests.helpers import contacts_of, free_step, resting_point
from tests.oracles.forms import exact_form_of


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-6", "frictionless"])
def test_rows_that_a_cone_implies_are_those_that_elimination_finds(cone):
    """Of one contact, whose four lengths are independent: no rows imply more than its cone."""
    step = resting_point().replace(cone=cone)
    form = StepProgram(step)
    of_contact = range(int(step.counts[0]))
    for size in range(5):
        for working in itertools.combinations(of_contact, size):
            if independent_rows(form, working) != working:
                continue
            shown = implied(form.integers(working), form.integers(of_contact))
            right = [i for i, is_implied in zip(of_contact, shown, strict=True) if is_implied]
            assert form.implied_by_cone(working, of_contact) == right
            assert Minimiser(form, working).implied(of_contact) == right


@pytest.mark.parametrize("cone", ["pyramid", "facets-6"])
@pytest.mark.parametrize("other", ["same", "negative", "other"])
def test_rows_that_a_shared_spin_implies_are_those_that_elimination_finds(cone, other):
    """Two points of a body of seven coordinates: nothing but the spin can tie them."""
    J = np.zeros((2, 4, 7))
    J[0, :3, :3] = J[1, :3, 3:6] = np.eye(3)
    J[0, 3, [2, 6]] = 0.75, 1.5
    J[1, 3] = {"same": 1, "negative": -1, "other": 1}[other] * J[0, 3]
    J[1, 3, 6] += other == "other"
    at = contacts_of(0.0, np.tile(np.eye(3), (2, 1, 1)), J, 0.5, [0.25, 0.5], rows=6)
    form = StepProgram(free_step(np.eye(7), np.zeros(7), at, 0.5).replace(cone=cone))
    rows = range(form.m)
    of_one = form.m // 2
    told = 0
    for size in (4, 5, 6):
        for working in itertools.combinations(rows, size):
            if independent_rows(form, working) != working:
                continue
            shown = implied(form.integers(working), form.integers(rows))
            right = [i for i, is_implied in zip(rows, shown, strict=True) if is_implied]
            says = form.implied_by_cone(working, rows)
            alone = [
                i
                for c in (rows[:of_one], rows[of_one:])
                for i in form.implied_by_cone([j for j in working if j in c], c)
            ]
            assert {*says} <= {*right}
            assert says == right or other == "other"
            told += says != alone
    assert (told > 0) == (other != "other")


def test_balls_that_hide_x_are_formed_again():
    """What rows (1, 0) and (1, 2^-150) say of another set loses 300 of 320 bits."""
    A = np.array([[1.0, 0.0], [1.0, 2.0**-150], [0.0, 1.0]])
    form = exact_form_of(np.eye(2), np.array([-1.0, 1.0]), A, np.array([1.0, 2.0, 3.0]))
    near = UpdatedInverse(form, (0, 1), form.bits)
    minimiser = Minimiser(form, (1, 2), near)
    _, radius = ball_point(form, (1, 2), form.bits, near).floats
    _, formed_again = minimiser.balls.floats
    assert radius.max() > 1e-6
    assert formed_again.max() < 1e-90
    assert minimiser.near_sets is not near
