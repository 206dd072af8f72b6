"""The proof of a right guess: what float64 claims is true, and every sign and rounding is exact."""

import itertools

import numpy as np
import pytest

from quasistatic_ref.certify.form import implied, independent_rows
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.certify.step_form import StepForm
from quasistatic_ref.certify.working_set import UpdatedInverse, ball_point
from tests.helpers import resting_point
from tests.oracles.forms import exact_form_of


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-6", "frictionless"])
def test_rows_that_a_cone_implies_are_those_that_elimination_finds(cone):
    """Of one contact, whose four lengths are independent: no rows imply more than its cone."""
    step = resting_point().replace(cone=cone)
    form = StepForm(step)
    of_contact = range(int(step.counts[0]))
    for size in range(5):
        for working in itertools.combinations(of_contact, size):
            if independent_rows(form, working) != working:
                continue
            shown = implied(form.integers(working), form.integers(of_contact))
            right = [i for i, is_implied in zip(of_contact, shown, strict=True) if is_implied]
            assert form.implied_by_cone(working, of_contact) == right
            assert Minimiser(form, working).implied(of_contact) == right


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
