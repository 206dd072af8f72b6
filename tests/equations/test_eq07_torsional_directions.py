"""Eq. (7), d~_5 and d~_6. Under test: step.friction.torsional_directions."""

import numpy as np

from quasistatic_ref.step.friction import pyramid, torsional_directions
from tests.helpers import random_step
from tests.tolerances import EXACT


def printed(contacts):
    return [[[0.0, 0.0, 0.0, mu], [0.0, 0.0, 0.0, -mu]] for mu in contacts.mu_omega]


def test_the_torsional_directions_are_plus_and_minus_mu_omega_on_the_spin(rng):
    contacts = random_step(rng).contacts
    actual = torsional_directions(contacts.mu_omega)
    np.testing.assert_allclose(actual, printed(contacts), rtol=EXACT, atol=EXACT)


def test_they_come_last_in_the_pyramid(rng):
    contacts = random_step(rng).contacts
    assert pyramid(contacts).shape == (3, 6, 4)
    np.testing.assert_allclose(pyramid(contacts)[:, 4:], printed(contacts), rtol=EXACT, atol=EXACT)
