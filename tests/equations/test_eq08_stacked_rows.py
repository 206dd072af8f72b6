"""Eq. (8), A and b of all contacts. Under test: step.standard_form.standard_form."""

import numpy as np

from quasistatic_ref import standard_form
from tests.closeness import assert_close, assert_same
from tests.helpers import PAPER, random_step, rows_by_hand


def test_A_is_contact_major_and_its_rows_are_the_printed_columns(rng):
    step = random_step(rng)
    form = standard_form(step)
    assert_close(form.A, rows_by_hand(step))
    assert_same(form.b, -np.repeat(step.contacts.phi, [6, 4, 6]))


def test_erratum_six_rows_for_fifteen_points_are_ninety_not_eighty(rng):
    everywhere = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 15))
    gripper_only = standard_form(random_step(rng, *PAPER))
    assert everywhere.A.shape == (90, 13)
    assert gripper_only.A.shape == (80, 13)
