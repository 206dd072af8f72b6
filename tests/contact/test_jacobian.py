"""Tangents are a fixed function of the normal."""

import numpy as np

from quasistatic_ref.contact.jacobian import tangents
from tests.closeness import assert_within


def test_d1_is_the_projection_of_the_world_axis_farthest_from_n_and_d2_is_n_x_d1(rng):
    """Of any normal, and of one along an axis: of axes as far from n the first is taken."""
    for n in [*rng.normal(size=(50, 3)), *np.eye(3), *(0.0 - np.eye(3))]:
        n /= np.linalg.norm(n)
        axis = np.eye(3)[min(range(3), key=lambda i: abs(n[i]))]
        d1 = axis - (axis @ n) * n
        d1 /= np.linalg.norm(d1)
        expected = [[d1], [np.cross(n, d1)]]
        found = np.array(tangents(n[None]))
        assert_within(found, expected)
        assert not np.signbit(found[found == 0]).any()
