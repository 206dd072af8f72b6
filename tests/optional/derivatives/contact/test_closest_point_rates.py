"""How closest points, corners on rims and tangents change, by differences."""

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
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.optional.derivatives.contact.contact_rates import (
    contact_rates,
    tangent_rates,
)
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.closeness import assert_within
from tests.contact.still import pair, placed_shape
from tests.oracles.differences import rate, unit
from tests.tolerances import DIFFERENCE_OF_STEPS

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

    def columns(of, place):
        """By place: contacts come as they rank."""
        return np.hstack([of.phi[:, None], of.n, of.alpha, of.beta])[np.argsort(place)]

    def moved(t):
        there = closest_points([one], system.kinematics(system.integrate(system.q_start, t * e)))
        return columns(there, there.point)

    expected = rate(moved)
    size = np.abs(expected).max()
    assert_within(columns(rates, points.point) @ e, expected, DIFFERENCE_OF_STEPS * size)


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


@pytest.mark.parametrize("first", ["fixed", "moving"])
def test_quarters_of_both_rims_of_a_tilted_cylinder_change_as_differences_say(first, rng):
    """The first corner of a rim is its point nearest to the floor, and slides along it."""
    body = Body.of_shape("body", Sphere(0.05), 0.3, xyz=(0.01, 0.02, 0.08), rpy=(0.4, 0.3, 0.2))
    system = System([body])
    floor = placed_shape(HalfSpace((0.0, 0.0, 1.0), 0.0))
    sides = [floor, placed_shape(Cylinder(0.04, 0.06), system.link("body"))]
    one = pair(*(sides if first == "fixed" else sides[::-1]), 8)
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
