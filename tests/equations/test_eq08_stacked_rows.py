"""Eq. (8), A and b of all contacts. Under test: step.standard_form.standard_form."""

import numpy as np

from quasistatic_ref import standard_form
from tests.closeness import assert_close
from tests.helpers import contact_row, random_step
from tests.tolerances import ROUNDING


def test_A_is_contact_major_and_its_rows_are_the_printed_columns(rng):
    step = random_step(rng, rows=(6, 4, 6))
    expected = []
    for j, count in enumerate((6, 4, 6)):
        for i in range(count):
            expected.append(contact_row(step.contacts, j, i))
    assert_close(standard_form(step).A, expected, ROUNDING)


def test_b_is_minus_phi_for_every_row_of_a_contact(rng):
    step = random_step(rng, rows=(6, 4, 6))
    expected = np.repeat(-step.contacts.phi, (6, 4, 6))
    np.testing.assert_array_equal(standard_form(step).b, expected)


def test_erratum_the_printed_columns_stacked_cannot_multiply_delta_q(rng):
    step = random_step(rng, n_a=3, n_u=4, rows=(6,))
    printed = np.vstack([contact_row(step.contacts, 0, i)[:, None] for i in range(6)])
    assert printed.shape == (6 * 7, 1)  # A delta_q needs 7 columns
    assert standard_form(step).A.shape == (6, 7)


def test_erratum_six_rows_for_fifteen_points_are_ninety_not_eighty(rng):
    everywhere = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 15))
    gripper_only = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 10 + (4,) * 5))
    assert everywhere.A.shape == (90, 13)
    assert gripper_only.A.shape == (80, 13)


def test_only_one_split_of_fifteen_contacts_gives_eighty_rows():
    assert [six for six in range(16) if 6 * six + 4 * (15 - six) == 80] == [10]
