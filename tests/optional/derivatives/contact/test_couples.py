"""Contacts as two features: which corners they are, how these slide on rims, which are level."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cone,
    Cylinder,
    HalfSpace,
    PointCloud,
    Sphere,
    System,
)
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.optional.derivatives.contact.contact_rates import (
    contact_rates,
    nearly_level,
)
from quasistatic_ref.optional.derivatives.contact.couples import (
    PairInWorld,
    Rim,
    couples,
    rim_velocity,
)
from quasistatic_ref.optional.derivatives.contact.features import Feature
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.contact.still import pair, placed_shape
from tests.oracles.differences import rate
from tests.tolerances import DIFFERENCE_OF_STEPS, ROUNDING

FLOOR = HalfSpace((0.0, 0.0, 1.0), 0.0)


def pair_of(system, fixed, moving, first, k):
    """A fixed shape at the origin and one of the body, either of them being alpha's."""
    sides = [placed_shape(fixed), placed_shape(moving, system.link("body"))]
    return pair(*(sides if first == "fixed" else sides[::-1]), k)


def body(xyz, rpy=(0.0, 0.0, 0.0)):
    return System([Body.of_shape("body", Sphere(0.05), 0.3, xyz=xyz, rpy=rpy)])


def couples_of(system, pair):
    where = system.kinematics(system.q_start)
    points = closest_points([pair], where)
    return points, couples([pair], points, where.R, where.t)


@pytest.mark.parametrize("first", ["fixed", "body"])
def test_corners_slide_along_a_tilted_rim_as_differences_say(first):
    # Of the eight corners of a cylinder over a floor the first of each rim is its lowest point,
    # the others are quarter turns from it: all slide as the cylinder turns.
    system = body((0.01, 0.02, 0.08), (0.4, 0.3, 0.2))
    pair = pair_of(system, FLOOR, Cylinder(0.04, 0.06), first, 8)
    points, found = couples_of(system, pair)
    assert {c.rim.quarter for c in found if c.rim is not None} == {0, 1, 2, 3}
    J = MotionRates(system.kinematics(system.q_start), system.column_map).J
    rates = contact_rates(found, J)
    assert rates.unique.all()
    for column, e in enumerate(np.eye(6)):

        def moved(t, e=e):
            there = closest_points(
                [pair], system.kinematics(system.integrate(system.q_start, t * e))
            )
            # Contacts come as they rank: these are put in the order of `points`, by their numbers.
            order = np.argsort(there.point)[np.argsort(np.argsort(points.point))]
            return np.stack([there.alpha[order], there.beta[order]])

        expected = rate(moved)
        for own, side in zip((rates.alpha, rates.beta), expected, strict=True):
            np.testing.assert_allclose(own[:, :, column], side, atol=DIFFERENCE_OF_STEPS)


def test_candidates_of_two_cones_are_tips_and_quarters_of_rims():
    # Alpha's candidates are 0 to 4, beta's 5 to 9: of each cone the tip, then its rim. On its base
    # the rim of a larger one is over no face, and five contacts fill the number: the closest pair
    # is on beta's rim.
    system = body((0.01, 0.0, -0.1001), (np.pi, 0.0, 0.0))
    _, found = couples_of(system, pair_of(system, Cone(0.05, 0.06), Cone(0.03, 0.04), "fixed", 11))
    expected = dict.fromkeys((0, 5, 11, 12, 13, 14, 15))
    expected |= {6 + quarter: Rim(1, quarter, 0.03) for quarter in range(4)}
    points = couples_of(system, found[0].of.pair)[0].point
    assert {int(k): c.rim for k, c in zip(points, found, strict=True)} == expected
    assert not any(c.crosses for c in found)
    _, found = couples_of(system, pair_of(system, Cone(0.03, 0.06), Cone(0.05, 0.04), "fixed", 11))
    rims = {c.rim for c in found if c.rim is not None}
    assert rims == {Rim(0, quarter, 0.03) for quarter in range(4)}


BLOCK = Box(np.full(3, 0.1))
PILL = Capsule(0.03, 0.05)


@pytest.mark.parametrize(
    ("shape", "xyz", "rpy", "k", "crossings"),
    [
        (BLOCK, (0.0, 0.0, 0.2001), (0.0, 0.0, np.pi / 4), 9, 8),
        (BLOCK, (0.0, 0.0, 0.2001), (0.0, 0.0, np.pi / 4), 1, 0),
        (PILL, (0.0601, 0.0, 0.0), (np.pi / 2, 0.0, 0.0), 2, 1),
    ],
)
def test_edges_cross_where_bodies_lie_across_each_other(shape, xyz, rpy, k, crossings):
    # Turned by 45 deg, each edge of a box crosses two of the other's; no corner is over the other.
    # The lines of capsules at a right angle cross once. A closest pair alone is no crossing.
    system = body(xyz, rpy)
    _, found = couples_of(system, pair_of(system, shape, shape, "fixed", k))
    assert sum(couple.crosses for couple in found) == crossings


def test_a_cloud_is_as_large_as_the_box_about_it():
    cloud = PointCloud([[5.0, 0.0, 0.0], [5.5, 0.0, 0.25]])
    bodies = tuple(ShapeInWorld(shape, np.eye(3), np.zeros(3)) for shape in (cloud, FLOOR))
    assert PairInWorld(pair(placed_shape(cloud), placed_shape(FLOOR, 1)), bodies).extents == (
        0.5,
        np.inf,
    )


def test_the_ball_about_a_capsule_s_corner_is_its_own():
    # The corners of a capsule are the ends of its segment, t +- half_length * axis.
    system = body((0.0, 0.0, 0.2), (0.4, 0.3, 0.2))
    capsule = Capsule(0.03, 0.05)
    _, found = couples_of(system, pair_of(system, FLOOR, capsule, "fixed", 2))
    own = found[0].of.bodies[1]
    ends = [own.t - 0.05 * own.R[:, 2], own.t + 0.05 * own.R[:, 2]]
    ends.sort(key=lambda end: end[2])
    for couple, end in zip(found, ends, strict=True):
        other, centre = couple.centre
        assert other == 0
        np.testing.assert_allclose(centre, end, atol=ROUNDING)


def test_a_level_rim_whose_body_turns_has_no_lowest_point():
    z = np.array([0.0, 0.0, 1.0])
    cylinder = ShapeInWorld(Cylinder(0.04, 0.06), np.eye(3), np.zeros(3))
    about_z = np.cross(z[:, None], z[:, None], axis=0)  # z x z: it does not tilt
    about_x = np.cross(np.array([[1.0], [0], [0]]), z[:, None], axis=0)
    rim = Rim(0, 1, 0.04)
    assert np.array_equal(rim_velocity(rim, cylinder, z, about_z), np.zeros((3, 1)))
    assert rim_velocity(rim, cylinder, z, about_x) is None


@pytest.mark.parametrize("away", [0.0, 5.0])
def test_nearly_level_is_a_matter_of_the_rim_and_of_a_slight_tilt(away):
    # Of a tilt between rounding and LEVEL, 1e-5, the lowest point of a rim is not well known.
    slight = (0.0, 3e-6, 0.0)
    much = (0.0, 1e-3, 0.0)
    for rpy, expected in ((slight, True), (much, False), ((0.0, 0.0, 0.0), False)):
        system = body((away, away, 0.06), rpy)
        _, (couple,) = couples_of(system, pair_of(system, FLOOR, Cylinder(0.04, 0.06), "fixed", 1))
        end = couple.of.bodies[1].t + couple.of.bodies[1].R @ np.array([0.04, 0.0, -0.06])
        assert nearly_level(couple._replace(points=(end, end))) == expected
        middle = couple.of.bodies[1].t + couple.of.bodies[1].R @ np.array([0.01, 0.0, -0.06])
        assert not nearly_level(couple._replace(points=(middle, middle)))


def test_merged_features_are_those_of_either_side_with_their_ends_free():
    x, y = np.eye(3)[:2]
    system = body((0.0, 0.0, 0.2))
    _, (couple,) = couples_of(system, pair_of(system, FLOOR, Box(np.full(3, 0.1)), "fixed", 1))
    one = Feature(np.eye(3), x[None], y[None])
    other = Feature(2 * np.eye(3), y[None])
    first, second = couple._replace(features=(one, other)).merged.features
    np.testing.assert_allclose(first.free.T @ first.free, np.diag([1.0, 1, 0]), atol=ROUNDING)
    assert np.array_equal(first.bend, one.bend)
    assert len(first.ends) == 0
    assert second is other
