"""The handle of a mug as points, and the bound of how far it sinks; docs/clouds.md hangs it."""

import numpy as np

from quasistatic_ref.lab.clouds.mug import ARC, HOOK, INNER, OFF, TUBE, handle_cloud, sink
from tests.closeness import assert_relative
from tests.tolerances import ROUNDING


def test_the_bound_is_of_second_order():
    """For a small spacing s: s^2 / 8 (1 / R_h - 1 / r), and s^2 / 8 / r_t across the tube."""
    s = 1e-4
    assert_relative(sink(s), s**2 / 8 * (1 / HOOK - 1 / INNER + 1 / TUBE), 1e-3)


def test_points_of_the_handle_are_on_its_tube():
    """(sqrt(x^2 + z^2) - R)^2 + y^2 = r_t^2 about the middle of the torus."""
    x, y, z = (handle_cloud(2e-3, np.random.default_rng(0)) - [OFF, 0, 0]).T
    assert_relative(np.hypot(np.hypot(x, z) - ARC, y), TUBE, ROUNDING)
    along = np.unique(np.arctan2(z, x).round(9))
    assert INNER * np.diff(along).max() <= 2e-3
