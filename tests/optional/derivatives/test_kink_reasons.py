"""Where a step has no derivative it says so, by name."""

import numpy as np
import pytest

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Cylinder,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Sphere,
)
from quasistatic_ref.simulate.simulator import Simulator
from tests.optional.derivatives.free_bodies import BOX, FLOOR, NONE, H, free, verdict
from tests.tolerances import DIFFERENCE_OF_STEPS
from validation.make.derivatives import after, rate


def test_a_box_that_lies_flat_and_sticks_on_four_corners_has_a_derivative():
    simulator, q = free(Box(np.array([0.1, 0.1, 0.05])), (0, 0, 0.0499), (FLOOR, (0, 0, 0)), k=4)
    found, kinds = verdict(simulator, q)
    assert kinds == set()
    # It sticks: wherever it stood before along the floor it stands after, at the floor's height.
    assert np.allclose(found.dq_dq[:, :2], np.eye(6)[:, :2], atol=1e-12)
    assert np.allclose(found.dq_dq[:, 2], 0, atol=1e-12)


@pytest.mark.parametrize(("distance", "kinds"), [(1e-9, 1), (1e-7, 1), (1e-5, 0)])
def test_so_near_to_an_edge_that_float64_does_not_know_the_normal(distance, kinds):
    # Places are right to 1e-16 m, and the normal to that over the distance.
    at = np.array([0.02, 0.1, 0.05]) + distance * np.array([0.0, 0.6, 0.8])
    simulator, q = free(PointCloud(np.zeros((1, 3))), at, (BOX, (0, 0, 0)))
    found, named = verdict(simulator, q, np.array([0, 0, -1.0, 0, 0, 0]))
    assert named == ({reason.NO_NORMAL} if kinds else set())
    assert np.isnan(found.dq_dq).all() == np.isnan(found.dq_dtau).all() == bool(kinds)


@pytest.mark.parametrize(("tilt", "kind"), [(1e-8, True), (3e-6, True), (1e-4, False)])
def test_a_rim_so_level_that_float64_does_not_know_its_lowest_point(tilt, kind):
    simulator, q = free(
        Cylinder(0.04, 0.06), (0, 0, 0.06), (FLOOR, (0, 0, 0)), k=4, rpy=(tilt, 0, 0)
    )
    named = verdict(simulator, q, np.array([0, 0, -1.0, 0, 0, 0]))[1]
    assert (reason.RIM in named) == kind


def test_a_kink_of_a_contact_that_is_far_away_does_not_matter():
    simulator, q = free(BOX, (0, 0, 0.5), (FLOOR, (0, 0, 0)))
    found, kinds = verdict(simulator, q)
    assert kinds == set()
    assert np.allclose(found.dq_dq, np.eye(6), atol=1e-2)


def test_points_that_slide_where_nothing_depends_on_it_do_no_harm():
    # In the plane, the upright edge of a box lies along the wall: which of its points is nearest
    # is open, and all of them move alike. Flush with the wall, one of its edges or the other is.
    wall = HalfSpace(np.array([1.0, 0, 0]), 0.0)
    x = 0.1 * np.cos(0.3) + 0.1 * np.sin(0.3) - 1e-4
    simulator, q = free(BOX, (x, 0, 0), (wall, (0, 0, 0)), rpy=(0, 0, 0.3), base="planar")
    force = np.array([-3.0, 1.0, 0.002])
    found, kinds = verdict(simulator, q, force)
    assert kinds == set()
    for e in np.eye(3):
        there = rate(
            lambda t, e=e: after(
                simulator, found.result.q, simulator.system.integrate(q, t * e), NONE, force
            )
        )
        size = np.abs(found.dq_dq).max()
        assert np.abs(found.dq_dq @ e - there).max() <= DIFFERENCE_OF_STEPS * size
    flush, q = free(BOX, (0.1 - 1e-4, 0, 0), (wall, (0, 0, 0)), base="planar")
    assert verdict(flush, q, force)[1] == {reason.MANY}


def test_a_normal_along_an_axis_is_no_kink_of_the_pyramid():
    simulator, q = free(Sphere(0.05), (0, 0, 0.0999), (Sphere(0.05), (0, 0, 0)))
    assert verdict(simulator, q, np.array([1.0, 0.2, 0, 0, 0, 0]))[1] == set()


def test_a_pair_without_friction_leaves_the_columns_of_the_others():
    wall = HalfSpace(np.array([1.0, 0, 0]), 0.0)
    system = System([Body.of_shape("body", Sphere(0.05), 0.3, xyz=(0.0499, 0, 0.0499))])
    own = PlacedShape("body", system.link("body"), np.eye(3), np.zeros(3), Sphere(0.05))
    pairs = [
        ContactPair(name, PlacedShape(name, 0, np.eye(3), np.zeros(3), shape), own, mu, 0.01, 6, 1)
        for name, shape, mu in (("wall", wall, 0.0), ("floor", FLOOR, 0.3))
    ]
    simulator = Simulator(system, pairs, h=H, K_q=np.zeros((0, 0)), fast=True)
    found, kinds = verdict(simulator, system.q_start, np.array([-3.0, 2.0, -1.0, 0, 0, 0]))
    assert kinds == {reason.ZERO_FRICTION}
    assert np.isnan(found.dq_dmu_v[:, 0]).all()
    assert np.isfinite(found.dq_dmu_v[:, 1]).all()
    assert found.dq_dmu_v[1, 1] < 0  # more friction, less sliding
