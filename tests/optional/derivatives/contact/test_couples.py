"""Contacts as two features: which corners they are, how these slide on rims, which are level."""

import numpy as np

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.contact.contact_rates import (
    merged_features,
)
from quasistatic_ref.optional.derivatives.contact.couples import Rim, couples, rim_velocity
from quasistatic_ref.optional.derivatives.contact.features import Feature
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Cone,
    Cylinder,
    HalfSpace,
    PlacedShape,
    Sphere,
)
from tests.tolerances import ROUNDING

FLOOR = HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0)
TANGENTS = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


def pair_of(system, fixed, moving, first, k):
    """A fixed shape at the origin and one of the body, either of them being alpha's."""
    sides = [
        PlacedShape("fixed", 0, np.eye(3), np.zeros(3), fixed),
        PlacedShape("body", system.link("body"), np.eye(3), np.zeros(3), moving),
    ]
    alpha, beta = sides if first == "fixed" else sides[::-1]
    return ContactPair("c", alpha, beta, 0.5, 0.01, 6, k)


def body(xyz, rpy=(0.0, 0.0, 0.0)):
    return System([Body.of_shape("body", Sphere(0.05), 0.3, xyz=xyz, rpy=rpy)])


def kept(system, pair, q=None):
    where = system.kinematics(system.q_start if q is None else q)
    points = closest_points([pair], where)
    return points, couples([pair], points, where.R, where.t)


def test_candidates_of_two_cones_are_tips_and_quarters_of_rims():
    # Alpha's candidates are 0 to 4, beta's 5 to 9: of each cone the tip, then its rim. On its base
    # the rim of a larger one is over no face, and four contacts fill the number.
    system = body((0.01, 0.0, -0.1001), (np.pi, 0.0, 0.0))
    _, found = kept(system, pair_of(system, Cone(0.05, 0.06), Cone(0.03, 0.04), "fixed", 11))
    expected = dict.fromkeys((0, 5, 10, 11, 12, 13, 14))
    expected |= {6 + quarter: Rim(1, quarter, 0.03) for quarter in range(4)}
    points = kept(system, found[0].of.pair)[0].point
    assert {int(k): c.rim for k, c in zip(points, found, strict=True)} == expected
    _, found = kept(system, pair_of(system, Cone(0.03, 0.06), Cone(0.05, 0.04), "fixed", 11))
    rims = {c.rim for c in found if c.rim is not None}
    assert rims == {Rim(0, quarter, 0.03) for quarter in range(4)}


def test_a_level_rim_whose_body_turns_has_no_lowest_point():
    z = np.array([0.0, 0.0, 1.0])
    cylinder = ShapeInWorld(Cylinder(0.04, 0.06), np.eye(3), np.zeros(3))
    about_z = np.cross(z[:, None], z[:, None], axis=0)  # z x z: it does not tilt
    about_x = np.cross(np.array([[1.0], [0], [0]]), z[:, None], axis=0)
    rim = Rim(0, 1, 0.04)
    assert np.array_equal(rim_velocity(rim, cylinder, z, about_z), np.zeros((3, 1)))
    assert rim_velocity(rim, cylinder, z, about_x) is None


def test_merged_features_are_those_of_either_side_with_their_ends_free():
    x, y = np.eye(3)[:2]
    system = body((0.0, 0.0, 0.2))
    _, (couple,) = kept(system, pair_of(system, FLOOR, Box(np.full(3, 0.1)), "fixed", 1))
    one, other = Feature(np.eye(3), x[None], y[None]), Feature(2 * np.eye(3), y[None])
    first, second = merged_features(couple._replace(features=(one, other)))
    np.testing.assert_allclose(first.free.T @ first.free, np.diag([1.0, 1, 0]), atol=ROUNDING)
    assert np.array_equal(first.bend, one.bend)
    assert len(first.ends) == 0
    assert second is other
