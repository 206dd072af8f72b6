"""Eq. (8), A and b of all contacts. Under test: step.standard_form.standard_form."""

from quasistatic_ref import standard_form
from tests.closeness import assert_close, assert_same
from tests.helpers import PAPER, contact_row, random_step
from tests.tolerances import ROUNDING


def test_A_is_contact_major_and_its_rows_are_the_printed_columns(rng):
    counts = 6, 4, 6
    step = random_step(rng, rows=counts)
    A, b = standard_form(step)[2:]
    rows = [(j, i) for j, count in enumerate(counts) for i in range(count)]
    assert_close(A, [contact_row(step.contacts, j, i) for j, i in rows], ROUNDING)
    assert_same(b, [-step.contacts.phi[j] for j, _ in rows])


def test_erratum_six_rows_for_fifteen_points_are_ninety_not_eighty(rng):
    everywhere = standard_form(random_step(rng, n_a=7, n_u=6, rows=(6,) * 15))
    gripper_only = standard_form(random_step(rng, *PAPER))
    assert everywhere.A.shape == (90, 13)
    assert gripper_only.A.shape == (80, 13)
