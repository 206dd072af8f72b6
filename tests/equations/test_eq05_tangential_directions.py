"""Eq. (5), d~_1 and d~_2. Under test: step.friction.tangential_directions."""

import numpy as np

from quasistatic_ref.step.friction import pyramid, tangential_directions
from tests.helpers import random_step
from tests.tolerances import EXACT


def printed(contacts):
    expected = []
    for j in range(contacts.n_c):
        d_tilde_1 = [contacts.mu_v[j] * contacts.d1[j][r] for r in range(3)] + [0.0]
        d_tilde_2 = [contacts.mu_v[j] * contacts.d2[j][r] for r in range(3)] + [0.0]
        expected.append([d_tilde_1, d_tilde_2])
    return expected


def test_the_first_two_directions_are_the_scaled_tangents(rng):
    contacts = random_step(rng).contacts
    actual = tangential_directions(contacts.d1, contacts.d2, contacts.mu_v)[:, :2]
    np.testing.assert_allclose(actual, printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_come_first_in_the_pyramid(rng):
    contacts = random_step(rng).contacts
    np.testing.assert_allclose(pyramid(contacts)[:, :2], printed(contacts), rtol=EXACT, atol=EXACT)
