"""Pictures of contacts: what slides in a run, and what of a cone a torque leaves."""

import numpy as np
import pytest
from matplotlib.patches import Polygon

import quasistatic_ref as qr
from quasistatic_ref.optional.show.figures import panels
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


def test_a_load_is_drawn_in_newtons():
    _, (axes,) = panels(4, 4)
    qr.figures.cone_with_load(axes, [1.0, 0.5, 4.0, 0.02], mu_v=0.5, mu_omega=0.01)
    dashed, left = (p.get_xy() for p in axes.patches if isinstance(p, Polygon))
    assert_relative(dashed.max(), 2.0)
    assert_relative(left.max(), 1.0)
    (arrow,) = axes.texts
    assert_relative(arrow.xy, (1.0, 0.5))
    with pytest.raises(qr.InputError, match="needs a normal force"):
        qr.figures.cone_with_load(axes, [0, 0, 0, 0], mu_v=0.5, mu_omega=0.0)


def test_a_map_shows_that_one_block_sticks_and_the_other_slides():
    run = qr.load_scenario("block_incline", ["steps=5"], fast=True).run()
    _, (axes,) = panels(4, 4)
    qr.figures.stick_slip_map(axes, run)
    (image,) = axes.images
    shown = np.array(["apart", "sticking", "sliding"])[np.asarray(image.get_array())]
    states = {name: set(shown[j]) - {"apart"} for j, name in enumerate(run.pair_names)}
    assert sorted(map(tuple, states.values())) == [("sliding",), ("sticking",)]


def test_a_map_of_a_light_record_is_refused():
    light = qr.load_scenario("block_incline", steps=2, fast=True, record="light")
    with pytest.raises(qr.InputError, match="does not know what slides"):
        qr.figures.stick_slip_map(panels()[1][0], light.run())
