"""How closest points, corners on rims and tangents change; points that slide along a line."""

from itertools import combinations_with_replacement

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Sphere,
    System,
    convex_hull,
)
from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.optional.derivatives.contact.closest_point_rates import closest_point_rates
from quasistatic_ref.optional.derivatives.contact.contact_rates import (
    contact_rates,
    tangent_rates,
)
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.contact.features import Feature
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.closeness import assert_within
from tests.contact.still import pair, placed_shape
from tests.oracles.differences import rate, unit
from tests.tolerances import DIFFERENCE_OF_STEPS, ROUNDING

X, Y, N = np.eye(3)
ACROSS = np.stack([X, Y])
PHI = 0.1
DIAGONAL = (X + Y) / np.sqrt(2)
EDGE, FACE = (Feature(free=free) for free in (DIAGONAL[None], ACROSS))


def feature_rates(features, v, omega):
    """Of two bodies at the origin and at PHI N that move by v and turn by omega, one coordinate."""
    velocity = np.array(v)[:, None, :, None]
    turn = np.array(omega)[:, None, :, None]
    phi = np.array([PHI])
    size = np.array([1.0])
    return closest_point_rates(phi, N[None], [*features], velocity, turn, size)


@pytest.mark.parametrize("features", [(EDGE, FACE), (FACE, EDGE)])
def test_an_edge_on_a_face_may_turn_about_itself_and_about_nothing_else(features):
    turned = [DIAGONAL if f is FACE else 0 * X for f in features]
    rates = feature_rates(features, (0 * X, 0 * X), turned)
    assert rates.unique[0]
    # The normal is the face's: dn = DIAGONAL x n.
    assert_within(rates.n[0, :, 0], np.cross(DIAGONAL, N), ROUNDING)
    for way in (np.cross(DIAGONAL, N), N, X):
        other = [way if f is FACE else 0 * X for f in features]
        assert not feature_rates(features, (0 * X, 0 * X), other).unique[0]
        # Both bodies turn as one about the first point.
        as_one = feature_rates(features, (0 * X, PHI * np.cross(way, N)), (way, way))
        assert as_one.unique[0]
        assert_within(as_one.n[0, :, 0], np.cross(way, N), ROUNDING)


def test_each_of_several_pairs_slides_along_its_own_line():
    """Edges along x and y on a face each: each edge turns about itself."""
    x, y, _ = np.eye(3)
    features = [Feature(free=x[None]), Feature(free=y[None]), FACE, FACE]
    velocity = np.zeros((2, 2, 3, 1))
    omega = np.zeros((2, 2, 3, 1))
    omega[0, :, :, 0] = x, y
    n = np.array([N, N])
    rates = closest_point_rates(np.full(2, PHI), n, features, velocity, omega, np.ones(2))
    assert rates.unique.all()
    assert_within(rates.n, 0.0, ROUNDING)  # the faces do not turn


SHAPES = (
    Sphere(0.05), Capsule(0.03, 0.05), Box((0.03, 0.05, 0.04)), Cylinder(0.04, 0.06),
    Cone(0.04, 0.06), Ellipsoid((0.03, 0.05, 0.04)), convex_hull(np.eye(4, 3) * 0.1 - 0.02),
)  # fmt: skip
PAIRS = list(combinations_with_replacement(SHAPES, 2))


def assert_changes_as_differences_say(one, system, e):
    """All closest points of a pair, as the system moves along e; none is at a kink by chance."""
    where = system.kinematics(system.q_start)
    points = closest_points([one], where)
    kept = couples([one], points, where.R, where.t)
    rates = contact_rates(kept, MotionRates(where, system.column_map).J)
    assert rates.unique.all()

    def moved(t):
        there = closest_points([one], system.kinematics(system.integrate(system.q_start, t * e)))
        columns = np.hstack([there.phi[:, None], there.n, there.alpha, there.beta])
        return columns[np.argsort(there.point)]  # contacts come as they rank

    of_phi = rates.phi[:, None]
    closed_form = np.concatenate([of_phi, rates.n, rates.alpha, rates.beta], axis=1) @ e
    expected = rate(moved)
    size = np.abs(expected).max()
    assert_within(closed_form[np.argsort(points.point)], expected, DIFFERENCE_OF_STEPS * size)


@pytest.mark.parametrize(
    "shapes", PAIRS, ids=["-".join(type(s).__name__ for s in two) for two in PAIRS]
)
def test_r29_random_pairs_change_as_differences_say(shapes, rng):
    bodies = [
        Body.of_shape(name, Sphere(0.05), 0.3, xyz=xyz, rpy=rng.uniform(-3, 3, 3))
        for name, xyz in (("a", np.zeros(3)), ("b", 0.16 * unit(rng, 3)))
    ]
    system = System(bodies)
    one = pair(*(placed_shape(s, system.link(b.name)) for s, b in zip(shapes, bodies, strict=True)))
    assert_changes_as_differences_say(one, system, rng.normal(size=12))


FLOOR = HalfSpace((0.0, 0.0, 1.0), 0.0)
CORNERS = {
    "quarters of two rims": (FLOOR, Cylinder(0.04, 0.06), (0.01, 0.02, 0.08), (0.4, 0.3, 0.2), 8),
    "ends of a capsule": (FLOOR, Capsule(0.03, 0.05), (0.0, 0.0, 0.2), (0.4, 0.3, 0.2), 2),
    "tips and rims of two cones": (
        Cone(0.05, 0.06), Cone(0.03, 0.04), (0.01, 0.0, -0.1001), (np.pi - 0.1, 0.05, 0.0), 6
    ),
}  # fmt: skip


@pytest.mark.parametrize("first", ["fixed", "moving"])
@pytest.mark.parametrize("corners", CORNERS)
def test_corners_of_a_tilted_body_change_as_differences_say(corners, first, rng):
    """The first corner of a rim is its point nearest to the other body, and slides along it."""
    fixed, moving, xyz, rpy, k = CORNERS[corners]
    system = System([Body.of_shape("body", Sphere(0.05), 0.3, xyz=xyz, rpy=rpy)])
    sides = [placed_shape(fixed), placed_shape(moving, system.link("body"))]
    one = pair(*(sides if first == "fixed" else sides[::-1]), k)
    assert_changes_as_differences_say(one, system, rng.normal(size=6))


def test_r34_tangents_change_as_written(rng):
    """d(d1) = tau d2 - (d1 . dn) n, d(d2) = -tau d1 - (d2 . dn) n, tau = -(c / s) d2 . dn."""
    n = rng.normal(size=(200, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    d_n = np.cross(rng.normal(size=(200, 3)), n)
    contacts = contacts_of(0.0, np.stack([*tangents(n), n], axis=1), np.zeros((200, 4, 0)), 0.5)

    def turned(t):
        moved = n + t * d_n
        return np.array(tangents(moved / np.linalg.norm(moved, axis=1)[:, None]))

    found = np.array(tangent_rates(contacts, d_n[:, :, None]))[..., 0]
    assert_within(found, rate(turned), DIFFERENCE_OF_STEPS * 10)
