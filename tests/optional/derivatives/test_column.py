"""Kinks are named by what differs across them, and where steps have a derivative there is one."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    PointCloud,
    Simulator,
    Sphere,
    System,
    derivatives,
)
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import joint, link, robot
from tests.optional.derivatives.free_bodies import BOX, FLOOR, NONE, POINT, H, free, slope

DOWN = np.array([0, 0, -1.0, 0, 0, 0])
ASKEW = np.array([0.3, 0.2, -1.0, 0.01, 0.02, 0.01])
PILL = Capsule(0.03, 0.05)
BAR = Box((0.02, 0.2, 0.05))
BAR_ACROSS = Box((0.2, 0.02, 0.05))
WHEEL = robot(link("rail"), link("wheel"), joint("turn", "rail", "wheel", "continuous", "0 0 1"))


def five_points():
    """Points 0 and 3 are level, but for 1e-13 m."""
    angle = 2.4 * np.arange(5)
    heights = np.array([0.02 + 1e-13, 0.0, 0.01, 0.02, 0.03])
    return PointCloud(np.stack([0.03 * np.cos(angle), 0.03 * np.sin(angle), heights], axis=1))


SMOOTH = {
    "of five points two that bear nothing tie": lambda: free(five_points(), (0, 0, 0), FLOOR, k=3),
    "faces that cross without a corner": lambda: free(BAR_ACROSS, (0, 0, 0.1), BAR, k=4),
    "a cylinder that stands upright on its rim": (
        lambda: free(Cylinder(0.04, 0.06), (0, 0, 0.06), FLOOR, k=4)
    ),
    "a box over an edge": lambda: free(Box((0.05, 0.04, 0.03)), (0.08, 0, 0.08), BOX, k=4),
    "capsules that lie across each other": (
        lambda: free(PILL, (0.0599, 0, 0), PILL, k=2, rpy=(np.pi / 2, 0, 0))
    ),
}
"""Closest points jump or part here, and steps do not notice."""


@pytest.mark.parametrize("force", [DOWN, ASKEW], ids=["down", "askew"])
@pytest.mark.parametrize("scene", SMOOTH.values(), ids=SMOOTH)
def test_a_step_that_changes_linearly_along_random_directions_has_a_derivative(scene, force, rng):
    simulator, q = scene()
    found = derivatives(simulator, q, NONE, force)
    assert found.differentiable, found.reasons
    for e in rng.uniform(-1, 1, (3, 6)):
        for size in (1e-6, -1e-6):
            there = slope(simulator, found.result.q, q, e, force, size=size)
            assert_within(there, found.dq_dq @ e, 1e-7)


def ball_on_ball(n):
    """So slippery that it does not roll."""
    at = 0.0999 * np.array(n) / np.linalg.norm(n)
    return free(Sphere(0.05), at, Sphere(0.05), mu=(0.1, 0.01))


KINKS = {
    "of points that are equally near one is kept": (
        lambda: free(PointCloud([[0.1, 0, 0], [-0.1, 0, 0]]), (0, 0, 0), FLOOR),
        {"c0/0", "c0/1"},
    ),
    "a box that lies flat, of which one point is kept": (
        lambda: free(BOX, (0, 0, 0.05), FLOOR),
        {"+d1 of c0/0", "-d1 of c0/0", "+d2 of c0/0", "-d2 of c0/0"},
    ),
    "a normal as far from two axes of the world": (
        lambda: ball_on_ball((1.0, 1.0, 2.0)),
        {"+d2 of c0/0", "-d2 of c0/0"},
    ),
    "a ball over the rim of a face": (lambda: free(Sphere(0.05), (0.1, 0, 0.0999), BOX), set()),
    "a point at a centre of curvature": (
        lambda: free(POINT, ((0.3**2 - 0.1**2) / 0.3, 0, 0), Ellipsoid((0.3, 0.2, 0.1))),
        set(),
    ),
}
"""A scene, and the rows and points that differ across its kinks."""


@pytest.mark.parametrize(("scene", "names"), KINKS.values(), ids=KINKS)
def test_a_constructed_kink_is_named_by_the_rows_and_points_that_differ(scene, names):
    simulator, q = scene()
    found = derivatives(simulator, q, NONE, DOWN)
    assert {name for why in found.reasons for name in (*why.rows, *why.points)} == names
    assert {field for why in found.reasons for field in why.fields} == {"dq_dq"}
    for why in found.reasons:
        assert all(name in why.sentence for name in (*why.rows, *why.points))
        assert names or "same rows and points" in why.sentence
    assert np.isfinite(found.dq_dtau).all()


def test_a_free_joint_reaches_its_target_also_half_a_turn_away():
    """The way there jumps from one side to the other, and where it ends does not."""
    wheel = Body("hand", WHEEL, actuated=("turn",))
    hand = Body.of_shape("hand", Sphere(0.05), 0.3, actuated=["base"])
    for body, half in ((wheel, [-1, 0]), (hand, [0, 0, 0.1, 0, 0.6, 0.8, 0])):
        system = System([body])
        simulator = Simulator(system, [], h=H, K_q=np.eye(system.n_a), backend="none")
        found = derivatives(simulator, system.q_start, half)
        assert_within(found.dq_dq, 0.0 * found.dq_dq, 1e-9)
        assert_within(found.dq_dq_bar_a, np.eye(system.n_v), 1e-9)
