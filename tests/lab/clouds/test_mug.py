"""A mug on a hook: what a cloud, capsules and a hull of its handle make of it."""

import numpy as np
import pytest

from quasistatic_ref.lab.clouds.mug import (
    ARC,
    HOOK,
    INNER,
    OFF,
    TUBE,
    handle_cloud,
    handle_parts,
    hung,
    rise,
    sink,
    whole,
)
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import PointCloud
from tests.tolerances import ROUNDING

SPACINGS = (4e-3, 2e-3, 1e-3)


@pytest.mark.parametrize("count", [5, 13])
def test_capsules_lift_the_mug_by_the_sagitta_of_one(count):
    """A chord of the arc lies R (1 - cos(pi / 2n)) inside of it: so much higher hangs the mug."""
    found = hung(handle_parts(count))
    assert found.moved == 0.0
    np.testing.assert_allclose(-found.sunk, rise(count), atol=1e-9)


@pytest.mark.parametrize("spacing", SPACINGS)
def test_a_cloud_lets_it_sink_by_less_than_the_bound(spacing):
    for seed in range(3):
        cloud = handle_cloud(spacing, np.random.default_rng(seed))
        found = hung(whole(PointCloud(cloud)))
        assert 0.0 < found.sunk < sink(spacing)
        assert found.moved < 1e-3 * sink(spacing)


def test_the_bound_is_of_second_order():
    """For a small spacing s: s^2 / 8 (1 / R_h - 1 / r), and s^2 / 8 / r_t across the tube."""
    s = 1e-4
    np.testing.assert_allclose(sink(s), s**2 / 8 * (1 / HOOK - 1 / INNER + 1 / TUBE), rtol=1e-3)


def test_points_of_the_handle_are_on_its_tube():
    """(sqrt(x^2 + z^2) - R)^2 + y^2 = r_t^2 about the middle of the torus."""
    x, y, z = (handle_cloud(2e-3, np.random.default_rng(0)) - [OFF, 0, 0]).T
    np.testing.assert_allclose(np.hypot(np.hypot(x, z) - ARC, y), TUBE, rtol=ROUNDING)
    along = np.unique(np.arctan2(z, x).round(9))
    assert INNER * np.diff(along).max() <= 2e-3


def test_a_hull_closes_the_handle_and_the_mug_falls():
    """The hook is inside of the hull: it is pushed out, and nothing bears the mug, h^2 g a step."""
    cloud = handle_cloud(2e-3, np.random.default_rng(0))
    found = hung(whole(convex_hull(cloud)))
    assert found.sunk > 0.05
    np.testing.assert_allclose(found.moved, 9.81e-4, rtol=ROUNDING)
