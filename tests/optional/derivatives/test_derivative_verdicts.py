"""Where a step has no derivative it says so, by name."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Cylinder,
    FastSimulator,
    PointCloud,
    Simulator,
    Sphere,
    System,
    derivatives,
    load_scenario,
)
from quasistatic_ref.optional.derivatives.step import reason
from tests.closeness import assert_within
from tests.model.urdf.urdf_texts import joint, link, robot
from tests.optional.derivatives.free_bodies import BOX, FLOOR, H, free, verdict

WHEEL = robot(link("rail"), link("wheel"), joint("turn", "rail", "wheel", "continuous", "0 0 1"))


def test_a_box_over_an_edge_is_borne_where_edges_cross():
    # Two of its lower corners are over the other box, and two edges cross that one's.
    simulator, q = free(Box((0.05, 0.04, 0.03)), (0.08, 0, 0.08), BOX, k=4)
    found, kinds = verdict(simulator, q)
    crossing = [why for why in found.reasons if why.kind == reason.CROSSING]
    assert reason.CROSSING in kinds
    assert len(crossing) == 2
    assert {why.fields for why in crossing} == {("dq_dq",)}


LOPSIDED = """<robot name="box"><link name="box"><inertial><origin xyz=".02 .02 0"/>
<mass value="1"/><inertia ixx="2e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size=".1 .1 .1"/></geometry></collision></link></robot>"""
FLOORS = {
    "a half-space": {"halfspace": {"normal": [0, 0, 1], "offset": 0}},
    "a box": {"box": {"size": [0.6, 0.6, 0.1]}, "pose": {"xyz": [0, 0, -0.05]}},
}


@pytest.mark.parametrize("floor", FLOORS)
def test_a_turn_by_rounding_changes_no_corner_of_a_box_that_lies_flat(floor):
    """With the middle of an edge in a corner's place, a turn of -1e-6 made a jump of 2.1e-3."""
    body = {"urdf": LOPSIDED, "base": "floating", "pose": {"xyz": [0, 0, 0.05]}}
    pair = {"alpha": "floor", "beta": "box", "mu_v": 0.5, "rows": 4, "k": 4}
    scene = {"h": 0.01, "steps": 1, "gravity": [0, 0, -9.81], "bodies": {"box": body}}
    scene |= {"shapes": {"floor": FLOORS[floor]}, "contacts": {"floor": pair}}
    scenario = load_scenario(scene)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    found = derivatives(simulator, q, np.zeros(0))
    assert found.differentiable
    for turn in np.eye(6)[3:5]:
        for eps in (1e-6, -1e-6):
            moved = simulator.step(scenario.system.integrate(q, eps * turn), np.zeros(0)).q
            change = scenario.system.difference(found.result.q, moved) / eps
            assert_within(change, found.dq_dq @ turn, 1e-5)


KINKS = {
    "two points that are equally near, of which one is kept": (
        reason.POINTS,
        lambda: free(PointCloud([[0.1, 0, 0], [-0.1, 0, 0]]), (0, 0, 0), FLOOR),
    ),
    "a ball over the rim of a face": (
        reason.FEATURE,
        lambda: free(Sphere(0.05), (0.1, 0, 0.0999), BOX),
    ),
    "a box that lies flat, of which one point is kept": (
        reason.MANY,
        lambda: free(BOX, (0, 0, 0.05), FLOOR),
    ),
    "a point at a box's corner": (
        reason.NO_NORMAL,
        lambda: free(PointCloud(np.zeros((1, 3))), (0.1, 0.1, 0.05), BOX),
    ),
    "a normal as far from two axes of the world": (
        reason.TANGENTS,
        lambda: free(  # so slippery that it does not roll
            Sphere(0.05),
            0.0999 * np.array([1.0, 1, 2]) / np.sqrt(6),
            Sphere(0.05),
            mu=(0.1, 0.01),
        ),
    ),
    "a cylinder that stands upright on its rim": (
        reason.RIM,
        lambda: free(Cylinder(0.04, 0.06), (0, 0, 0.06), FLOOR, k=4),
    ),
    # Depths that tie by more than a step is refused for.
    "a point as deep below two faces": (
        reason.SURFACES,
        lambda: free(PointCloud(np.zeros((1, 3))), (0.09, 0, 0.04 + 4e-12), BOX),
    ),
}


@pytest.mark.parametrize(("kind", "scene"), KINKS.values(), ids=KINKS)
def test_a_constructed_kink_is_named(kind, scene):
    simulator, q = scene()
    found, kinds = verdict(simulator, q, np.array([0, 0, -1.0, 0, 0, 0]))
    assert kind in kinds, [str(why) for why in found.reasons]
    assert not found.differentiable
    assert np.isnan(found.dq_dq).all()
    assert np.isfinite(found.dq_dtau).any()
    assert all(why.where[0].startswith("c0") for why in found.reasons if why.kind == kind)


@pytest.mark.parametrize(("distance", "kinds"), [(1e-9, 1), (1e-7, 1), (1e-5, 0)])
def test_so_near_to_an_edge_that_float64_does_not_know_the_normal(distance, kinds):
    # Places are right to 1e-16 m, and the normal to that over the distance.
    at = np.array([0.02, 0.1, 0.05]) + distance * np.array([0.0, 0.6, 0.8])
    simulator, q = free(PointCloud(np.zeros((1, 3))), at, BOX)
    found, named = verdict(simulator, q, np.array([0, 0, -1.0, 0, 0, 0]))
    assert named == ({reason.NO_NORMAL} if kinds else set())
    assert np.isnan(found.dq_dq).all() == np.isnan(found.dq_dtau).all() == bool(kinds)


@pytest.mark.parametrize(("tilt", "kind"), [(1e-8, True), (3e-6, True), (1e-4, False)])
def test_a_rim_so_level_that_float64_does_not_know_its_lowest_point(tilt, kind):
    simulator, q = free(Cylinder(0.04, 0.06), (0, 0, 0.06), FLOOR, k=4, rpy=(tilt, 0, 0))
    named = verdict(simulator, q, np.array([0, 0, -1.0, 0, 0, 0]))[1]
    assert (reason.RIM in named) == kind


def test_a_kink_of_a_contact_that_is_far_away_does_not_matter():
    simulator, q = free(BOX, (0, 0, 0.5), FLOOR)
    found, kinds = verdict(simulator, q)
    assert kinds == set()
    assert np.allclose(found.dq_dq, np.eye(6), atol=1e-2)


def test_a_normal_along_an_axis_is_no_kink_of_the_pyramid():
    simulator, q = free(Sphere(0.05), (0, 0, 0.0999), Sphere(0.05))
    assert verdict(simulator, q, np.array([1.0, 0.2, 0, 0, 0, 0]))[1] == set()


def test_a_target_half_a_turn_away_is_named():
    system = System([Body("rail", WHEEL, actuated=("turn",))])
    simulator = FastSimulator(Simulator(system, [], h=H, K_q=np.eye(1)))
    found = derivatives(simulator, np.array([1.0, 0.0]), np.array([-1.0, 0.0]))
    assert [why.kind for why in found.reasons] == [reason.HALF_TURN]
    assert np.isnan(found.dq_dq_bar_a).all()
    assert derivatives(simulator, np.array([1.0, 0.0]), np.array([0.0, 1.0])).differentiable
