"""The friction cone and the wrench that the multipliers add up to."""

import numpy as np
import pytest

from quasistatic_ref.cli.solution_files import rounded_wrenches
from quasistatic_ref.step.friction import (
    contact_wrenches,
)
from tests.closeness import assert_close
from tests.helpers import point_on_floor, random_step
from tests.tolerances import ROUNDING


@pytest.mark.parametrize("row", range(6))
def test_each_row_alone_reaches_a_vertex_of_the_octahedron(row, rng):
    contacts = random_step(rng, rows=(6,)).contacts
    mu_v = contacts.mu_v[0]
    mu_omega = contacts.mu_omega[0]
    vertices = [
        [mu_v, 0, 1, 0],
        [0, mu_v, 1, 0],
        [-mu_v, 0, 1, 0],
        [0, -mu_v, 1, 0],
        [0, 0, 1, mu_omega],
        [0, 0, 1, -mu_omega],
    ]
    actual = contact_wrenches(contacts, np.eye(6)[row], h=0.5)
    expected = [np.array(vertices[row]) / 0.5]
    assert_close(actual, expected, ROUNDING)


def test_a_wrench_that_is_rounded_to_zero_has_no_sign():
    """Of -d2 a quarter of the least float64, over h = 1."""
    contacts = point_on_floor(mu_v=0.25).contacts
    wrench = rounded_wrenches(contacts, np.array([0.0, 0.0, 0.0, 5e-324]), 1.0)
    assert wrench[0].tolist() == [0.0, 0.0, 5e-324, 0.0]
    assert not np.signbit(wrench).any()


def test_a_wrench_beyond_float64_is_infinite_with_its_sign():
    contacts = point_on_floor(mu_v=0.25).contacts
    wrench = rounded_wrenches(contacts, np.array([0.0, 0.0, 0.0, 1e308]), 0.01)
    assert wrench[0].tolist() == [0.0, -np.inf, np.inf, 0.0]
