"""Eq. (6), d~_3 and d~_4. Under test: step.friction.tangential_directions."""

import numpy as np

from quasistatic_ref.step.friction import pyramid, tangential_directions
from tests.helpers import random_step
from tests.tolerances import EXACT


def printed(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_3 = [-contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_4 = [-contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_3, d_tilde_4])
    return expected


def test_the_last_two_directions_are_the_scaled_tangents_turned_round(rng):
    contacts = random_step(rng).contacts
    actual = tangential_directions(contacts.d1, contacts.d2, contacts.mu_v)[:, 2:]
    np.testing.assert_allclose(actual, printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_come_third_and_fourth_in_the_pyramid(rng):
    contacts = random_step(rng).contacts
    np.testing.assert_allclose(pyramid(contacts)[:, 2:4], printed(contacts), rtol=EXACT, atol=EXACT)
