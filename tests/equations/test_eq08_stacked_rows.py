"""Eq. (8), A and b of all contacts. Under test: step.standard_form.standard_form."""

import numpy as np

from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import contact_row, random_step
from tests.tolerances import EXACT, ROUNDING


def printed_column(contacts, j, i):
    """J'(n~ + d~_i) as printed: a column of n_v numbers, row k being column k of J."""
    return [[entry] for entry in contact_row(contacts, j, i)]


def test_A_is_contact_major_and_its_rows_are_the_printed_columns(rng):
    step = random_step(rng, rows=(6, 4, 6))
    expected = []
    for j, count in enumerate((6, 4, 6)):
        for i in range(count):
            column = printed_column(step.contacts, j, i)
            expected.append([column[k][0] for k in range(step.n_v)])
    np.testing.assert_allclose(standard_form(step).A, expected, rtol=ROUNDING, atol=ROUNDING)


def test_b_is_minus_phi_for_every_row_of_a_contact(rng):
    step = random_step(rng, rows=(6, 4, 6))
    expected = []
    for j, count in enumerate((6, 4, 6)):
        expected += [-step.contacts.phi[j]] * count
    np.testing.assert_allclose(standard_form(step).b, expected, rtol=EXACT, atol=EXACT)


def test_erratum_the_printed_columns_stacked_cannot_multiply_delta_q(rng):
    step = random_step(rng, n_a=3, n_u=4, rows=(6,))
    printed = np.vstack([printed_column(step.contacts, 0, i) for i in range(6)])
    assert printed.shape == (6 * 7, 1)  # A delta_q needs 7 columns
    transposed = np.vstack([np.transpose(printed_column(step.contacts, 0, i)) for i in range(6)])
    np.testing.assert_allclose(standard_form(step).A, transposed, rtol=ROUNDING, atol=ROUNDING)


def test_erratum_six_rows_for_fifteen_points_are_ninety_not_eighty(rng):
    everywhere = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 15))
    gripper_only = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 10 + (4,) * 5))
    assert everywhere.A.shape == (90, 13)
    assert gripper_only.A.shape == (80, 13)


def test_only_one_split_of_fifteen_contacts_gives_eighty_rows():
    assert [six for six in range(16) if 6 * six + 4 * (15 - six) == 80] == [10]
