"""Bounds of distances of points to a mesh give way where triangles are slim."""

import numpy as np
import pytest

from quasistatic_ref.shapes.facets import NEEDLE, SAFE, Facets
from tests.closeness import assert_relative


@pytest.mark.parametrize(("height", "share"), [(0.5, SAFE), (1e-9, NEEDLE / 1e-9)])
def test_a_margin_is_that_of_the_slimmest_triangle(height, share):
    """A base of 1 m: the sine of the least angle is at least the height over it; points at 2 m."""
    corners = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]]])
    facets = Facets(corners, np.array([[0.0, 0.0, 1.0]]), np.zeros(1))
    assert_relative(facets.margin(np.array([[0.0, 0.0, 2.0]])), share * (1.0 + 2.0))
