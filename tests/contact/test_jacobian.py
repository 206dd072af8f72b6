"""Tangents are a fixed function of the normal; contacts carry their layout and names."""

import numpy as np
import pytest

from quasistatic_ref.contact.jacobian import tangents
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

X, Y, Z = np.eye(3)
ALONG_AXES = {
    "+x": (X, Y, Z),
    "-x": (-X, Y, -Z),
    "+y": (Y, X, -Z),
    "-y": (-Y, X, Z),
    "+z": (Z, X, Y),
    "-z": (-Z, X, -Y),
}
"""n, d1, d2: d1 is the first world axis square to n, d2 = n x d1."""


@pytest.mark.parametrize(("n", "d1", "d2"), ALONG_AXES.values(), ids=ALONG_AXES)
def test_tangents_of_a_normal_along_an_axis_are_axes(n, d1, d2):
    found = tangents(n[None] + 0.0)  # as in contacts zero is 0.0
    np.testing.assert_array_equal(found, [[d1], [d2]])
    assert not np.signbit(found)[np.array(found) == 0].any()


def test_d1_is_the_projection_of_the_world_axis_farthest_from_n_and_d2_is_n_x_d1(rng):
    for n in rng.normal(size=(50, 3)):
        n /= np.linalg.norm(n)
        axis = np.eye(3)[min(range(3), key=lambda i: abs(n[i]))]
        d1 = axis - (axis @ n) * n
        d1 /= np.linalg.norm(d1)
        expected = [[d1], [np.cross(n, d1)]]
        assert_within(tangents(n[None]), expected, ROUNDING)
