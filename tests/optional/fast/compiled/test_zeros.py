"""Zeros of degenerate steps, and the claims of an optimum, decided in C as by the exact method."""

from collections import Counter

import numpy as np
import pytest

from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.contacts import repeated
from tests.certify.test_exact import resting_point
from tests.helpers import changed
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.rows_given import half_way
from validation.make.confirmed_bits import differing_fields, proof
from validation.make.degenerate_bits import faults

pytestmark = needs_compiler
SPINS = [4, 5]
"""Rows of a contact. Both of its spins hold its gap and its spin."""


def proof_on(step, working):
    return proof(step, np.array(working, dtype=np.int64))


def test_degenerate_steps_have_the_bits_of_the_exact_method():
    """A sample of validation/make/degenerate_bits.py."""
    found = Counter()
    for seed in range(120):
        counts, wrong = faults(seed)
        assert wrong == []
        found.update(counts)
    assert found["proved"] > 0.85 * found["optima"] > 50


@pytest.mark.parametrize(
    ("loads", "working", "unique", "smooth"),
    [
        # Nothing pushes sideways: both slips of a pair have no slack, and their sum is twice the
        # gap, which the spins hold. So all of them are strictly active.
        ({}, SPINS, False, True),
        # Nothing presses: no row is spanned, and all slacks grow with the gap.
        ({"weight": 0.0}, [], True, False),
    ],
)
def test_claims_of_rows_without_slack(loads, working, unique, smooth):
    step = resting_point(**loads)
    found = proof_on(step, working)
    assert (found.multipliers_unique, found.differentiable) == (unique, smooth)
    assert differing_fields(found, form_optimum(exact_form(step), working)) == []


def test_rows_that_other_contacts_span_are_zero_although_no_combination_of_their_own_shows_it():
    """The contact once more, with J half as large: its rows are half those of the first."""
    step = resting_point()
    twice = repeated(step.contacts, [0, 0])
    J = twice.J.copy()
    J[1] /= 2
    step = step.replace(contacts=changed(twice, J=J))
    found = proof_on(step, SPINS)
    assert isinstance(found, ExactOptimum)
    assert (found.multipliers_unique, found.differentiable) == (False, True)
    assert differing_fields(found, form_optimum(exact_form(step), SPINS)) == []


def test_a_slack_that_is_small_but_not_zero_is_no_zero():
    """A weight of 3 N and a push of 2^-300 N: it moves by 2^-300 h^2 / m."""
    step = resting_point(tau_x=2.0**-300)
    found = proof_on(step, SPINS)
    truth = form_optimum(exact_form(step), SPINS)
    assert truth.working_set != tuple(SPINS)
    assert not isinstance(found, ExactOptimum) or differing_fields(found, truth) == []


@pytest.mark.parametrize("k", [1, 3])
def test_numbers_half_way_between_two_others_are_the_even_ones(k):
    step = half_way(k)
    found = proof_on(step, [0, 1])
    assert isinstance(found, ExactOptimum)
    assert differing_fields(found, form_optimum(exact_form(step), (0, 1))) == []
    even = 1.0 if k == 1 else 1 + 2.0**-51  # 1 + 2^-53 and 1 + 3 2^-53
    assert found.delta_q[0] == even
    assert found.slack[2] == even
