"""The friction that a cone allows without torque."""

import numpy as np
import pytest

from quasistatic_ref.optional.show.figures.friction_cone import rim
from tests.closeness import assert_relative


@pytest.mark.parametrize(
    ("cone", "corners"), [("pyramid", 4), ("product", 4), ("facets-6", 6), ("ellipsoid", 48)]
)
def test_the_rim_of_a_cone_is_a_polygon_in_the_unit_circle(cone, corners):
    x, y = rim(cone).T
    area = 0.5 * abs(x @ np.roll(y, 1) - y @ np.roll(x, 1))
    assert_relative(area, corners / 2 * np.sin(2 * np.pi / corners))


def test_without_friction_there_is_no_rim():
    assert rim("frictionless").shape == (0, 2)
