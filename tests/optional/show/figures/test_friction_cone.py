"""What of a cone a torque leaves."""

import numpy as np
import pytest

from quasistatic_ref.optional.show.figures.friction_cone import limit_at
from tests.closeness import assert_relative


@pytest.mark.parametrize(
    ("cone", "area"),
    [("pyramid", 2 * 0.4**2), ("product", 2.0), ("ellipsoid", 0.64 * 24 * np.sin(2 * np.pi / 48))],
)
def test_what_a_torque_leaves_of_a_cone(cone, area):
    """A square whose diagonal shrinks by the share, a square that stays, a 48-gon in a circle."""
    x, y = limit_at(cone, 0.6).T
    assert_relative(0.5 * abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)), area)
