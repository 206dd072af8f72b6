"""What coal answers is checked before it is used, mended or refused."""

import coal
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Box, Cone, ContactError, Cylinder, Ellipsoid, ModelError, convex_hull
from quasistatic_ref.contact.normals import gaps
from quasistatic_ref.optional.curved import by_coal
from quasistatic_ref.optional.curved.by_coal import coal_witness
from quasistatic_ref.optional.curved.ways_out import REACH, rival_directions
from tests.closeness import assert_relative, assert_within
from tests.contact.still import found_for, in_world, placed_shape, standing_links
from tests.tolerances import COAL, CURVED_PAIR

PLANTED = {
    "normal turned round": lambda r: setattr(r, "normal", -np.array(r.normal)),
    "normal of another direction": lambda r: setattr(r, "normal", np.roll(np.array(r.normal), 1)),
    "always the same normal": lambda r: setattr(r, "normal", np.array([1.0, 0.0, 0.0])),
    "normal too long": lambda r: setattr(r, "normal", 1.1 * np.array(r.normal)),
    "no normal": lambda r: setattr(r, "normal", np.zeros(3)),
    "normal NaN": lambda r: setattr(r, "normal", np.full(3, np.nan)),
    "distance": lambda r: None,
}


REFUSED = ("normal of another direction", "no normal", "normal NaN")


@pytest.mark.parametrize("spoil", PLANTED)
@pytest.mark.parametrize("gap", [0.1, 0.0, -0.01])
def test_a_bad_answer_of_coal_is_mended_or_refused(monkeypatch, spoil, gap):
    honest = coal.distance

    def spoilt(*arguments):
        phi = honest(*arguments)
        PLANTED[spoil](arguments[-1])
        return phi + 1e-3 * (spoil == "distance")

    monkeypatch.setattr(coal, "distance", spoilt)
    cone = Cone(0.15, 0.2)  # boxes have a closed form, and so have cylinders that are apart
    kinematics = standing_links((np.eye(3), np.array([0.0, 0.0, 0.4 + gap])))
    try:
        found = found_for(placed_shape(cone), placed_shape(cone, 1), kinematics)
    except ContactError as error:
        found = error
    if isinstance(found, ContactError):
        assert str(found).startswith("p: the contact normal is not reliable")
        assert spoil != "distance"
        return
    assert spoil not in REFUSED or gap >= 0  # apart, the nearest corner mends it
    # The lower cone's tip is at z = 0.2, the upper one's base at 0.2 + gap.
    assert_within(found.phi, [gap], CURVED_PAIR)
    assert_within(found.n, [[0, 0, 1]], CURVED_PAIR)


X = np.eye(3)[0]
SLANTING = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])


def tips(gap, at=(0.0, 0.0, 0.0)):
    """Two ellipsoids whose longest axes are in line, along x, tip to tip."""
    one = Ellipsoid((0.125, 0.05, 0.04))
    two = Ellipsoid((0.25, 0.03, 0.06))
    return in_world(one, at), in_world(two, at + (0.375 + gap) * X)


def without_normals(monkeypatch, answers):
    """So many answers of coal lack the normal."""
    honest = coal.distance
    left = list(range(answers))

    def spoilt(*arguments):
        found = honest(*arguments)
        if left:
            left.pop()
            arguments[-1].normal = np.full(3, np.nan)
        return found

    monkeypatch.setattr(coal, "distance", spoilt)


def test_ellipsoids_are_as_far_apart_as_their_tips_however_far():
    for gap in (0.1, 10.0, 1e3):
        found = coal_witness("p", *tips(gap))
        assert_relative(found.phi, gap)
        assert_within(found.n, X, CURVED_PAIR)


@pytest.mark.parametrize("t", [(0.375, 0.25, 0.125), (0.25, 0.0625, 0.03125)])
def test_an_answer_does_not_depend_on_where_the_world_has_its_origin(t):
    # Apart, and in penetration; all of these numbers are exact.
    found = []
    for origin in (0.0, 2.0**20):
        one, two = tips(0.0, at=(origin, 0, 0))
        found.append(coal_witness("p", one, in_world(two.shape, one.t + t, SLANTING)))
    assert found[0].phi == found[1].phi
    assert found[0].n.tolist() == found[1].n.tolist()


def test_flat_ends_touch_at_a_point_of_both_that_moves_with_them():
    below, above = Cylinder(0.05, 0.02), Cylinder(0.03, 0.02)
    apart = np.array([0.04, 0.0, 0.04])
    points = []
    for t in (np.zeros(3), np.array([1.0, 0.5, 0.25])):
        found = coal_witness("p", in_world(below, t), in_world(above, t + apart))
        points.append(found.alpha - t)
    assert_within(points[1], points[0], CURVED_PAIR)
    assert np.hypot(*points[0][:2]) < 0.05
    assert np.hypot(*(points[0] - 0.04 * X)[:2]) < 0.03


@pytest.mark.parametrize("gap", [10.0, -0.01])
def test_a_pair_that_is_refused_has_coal_s_distance_in_the_message(monkeypatch, gap):
    without_normals(monkeypatch, 1000)
    with pytest.raises(ContactError, match="the contact normal is not reliable") as refused:
        coal_witness("p", *tips(gap))
    assert_within(refused.value.value["phi"], gap, 10 * COAL)


BOX = Box((0.1, 0.12, 0.14))
GRAIN = Ellipsoid((0.02, 0.021, 0.022))


@pytest.mark.parametrize("swapped", [True, False])
@pytest.mark.parametrize(("y", "ways"), [(0.1, [1]), (-0.1, [-1]), (0.0, [-1, 1])])
def test_the_shortest_way_out_of_a_box_is_found_from_a_longer_one(monkeypatch, y, ways, swapped):
    """A face of the box is 0.12 - |y| away, and the grain reaches 0.021 behind; or 0.1 and 0.02."""
    without_normals(monkeypatch, len(by_coal.ACCURACIES))  # the direction that is tried then is x
    way = 1 if y else 0
    phi = abs(y) - 0.12 - 0.021 if y else -0.1 - 0.02
    both = [in_world(BOX), in_world(GRAIN, (0.0, y, 0.0))]
    found = coal_witness("p", *(both[::-1] if swapped else both))
    assert_within(found.phi, phi, CURVED_PAIR)
    assert_within(abs(found.n), np.eye(3)[way], CURVED_PAIR)
    assert np.sign(found.n[way]) * (-1 if swapped else 1) in ways


def test_a_deep_way_out_that_settles_slowly_is_found():
    """An ellipsoid E reaches |E S' n| behind the nearest face of a box of its own size."""
    half = np.array([0.03, 0.05, 0.08])
    t = np.array([0.01, 0.02, 0.03])
    S = Rotation.from_euler("xyz", [0.3, 0.4, 1.1]).as_matrix()
    found = coal_witness("p", in_world(Box(half)), in_world(Ellipsoid(half), t, S))
    expected = (t - half - np.linalg.norm(S * half, axis=1)).max()
    assert_within(found.phi, expected, CURVED_PAIR)


def test_a_smooth_way_out_between_all_axes_is_near_a_sample():
    """Discs tilted by 0.35 and -0.35 about x: the sum of their reaches is least along z and -z."""
    tilted = [Rotation.from_rotvec([angle, 0, 0]).as_matrix() for angle in (0.35, -0.35)]
    disc = Ellipsoid((0.1, 0.1, 0.05))
    a, b = (in_world(disc, R=tilt) for tilt in tilted)
    z = np.array([0.0, 0.0, 1.0])
    (found,) = rival_directions(a, b, z, float(gaps(a, b, z[None])[0]), 0.05)
    assert found @ -z > np.cos(REACH)


def test_a_fan_of_many_edges_has_no_distance_to_a_cone():
    turn = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    rim = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(300)])
    fan = convex_hull(np.vstack([rim, [[0, 0, 1]]]))
    kinematics = standing_links((np.eye(3), np.array([0.0, 0.0, 2.0])))
    with pytest.raises(ModelError, match="has a corner with more than 254 edges"):
        found_for(placed_shape(fan), placed_shape(Cone(0.15, 0.2), 1), kinematics)
