"""Where a step has no derivative it says so, by name."""

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
    convex_hull,
    derivatives,
)
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.tolerances import TIED
from tests.closeness import assert_within
from tests.contact.still import placed_shape
from tests.model.urdf.urdf_texts import joint, link, robot
from tests.optional.derivatives.free_bodies import (
    BOX,
    FLOOR,
    NONE,
    POINT,
    H,
    free,
    touching,
    verdict,
)
from tests.oracles.differences import after

WHEEL = robot(link("rail"), link("wheel"), joint("turn", "rail", "wheel", "continuous", "0 0 1"))
RAIL = robot(link("rail"), link("slider"), joint("slide", "rail", "slider", "prismatic", "0 0 1"))


LOPSIDED = """<robot name="box"><link name="box"><inertial><origin xyz=".02 .02 0"/>
<mass value="1"/><inertia ixx="2e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size=".1 .1 .1"/></geometry></collision></link></robot>"""
SLAB = Box((0.3, 0.3, 0.05))


def test_a_turn_by_rounding_changes_no_corner_of_a_box_that_lies_flat():
    """With the middle of an edge in a corner's place, a turn of -1e-6 made a jump of 2.1e-3."""
    system = System([Body("box", LOPSIDED, "floating", xyz=(0, 0, 0.05))])
    floor = placed_shape(SLAB, t=(0, 0, -0.05))
    simulator, q = touching(system, floor, system.shapes[0], 4, (0.5, 0.0))
    found = derivatives(simulator, q, NONE)
    assert found.differentiable
    for turn in np.eye(6)[3:5]:
        for eps in (1e-6, -1e-6):
            change = after(simulator, found.result.q, system.integrate(q, eps * turn), NONE) / eps
            assert_within(change, found.dq_dq @ turn, 1e-5)


DOWN = np.array([0, 0, -1.0, 0, 0, 0])
PILL = Capsule(0.03, 0.05)
BAR = Box((0.02, 0.2, 0.05))
BAR_ACROSS = Box((0.2, 0.02, 0.05))
PYRAMID = convex_hull([[0.1, 0.1, 0], [0.1, -0.1, 0], [-0.1, 0.1, 0], [-0.1, -0.1, 0], [0, 0, 0.1]])
PYRAMID_ON_ITS_TIP = convex_hull(-PYRAMID.vertices)
TRIANGLE = ((-0.2, -0.2), (0.05, -0.05), (-0.05, 0.05))
PRISM = convex_hull([[x, y, z] for x, y in TRIANGLE for z in (-0.05, 0.05)])


def five_points(higher=0.0):
    """Points 0 and 3 are level, but for how much higher 0 is [m]."""
    angle = 2.4 * np.arange(5)
    heights = np.array([0.02 + higher, 0.0, 0.01, 0.02, 0.03])
    return PointCloud(np.stack([0.03 * np.cos(angle), 0.03 * np.sin(angle), heights], axis=1))


def ball_on_ball(n):
    """So slippery that it does not roll."""
    at = 0.0999 * np.array(n) / np.linalg.norm(n)
    return free(Sphere(0.05), at, Sphere(0.05), mu=(0.1, 0.01))


def on_a_rail(fixed, shape, t, k):
    """A body that can only rise."""
    system = System([Body("rail", RAIL)])
    lying = placed_shape(shape, system.link("rail/slider"), t=t)
    return touching(system, placed_shape(fixed), lying, k)


KINKS = {
    "of points that are equally near one is kept": (
        reason.POINTS,
        lambda: free(PointCloud([[0.1, 0, 0], [-0.1, 0, 0]]), (0, 0, 0), FLOOR),
    ),
    "of five points two are as near as the third": (
        reason.POINTS,
        lambda: free(five_points(0.001 * TIED), (0, 0, 0), FLOOR, k=3),
    ),
    "a ball over the rim of a face": (
        reason.FEATURE,
        lambda: free(Sphere(0.05), (0.1, 0, 0.0999), BOX),
    ),
    "a box that lies flat, of which one point is kept": (
        reason.MANY,
        lambda: free(BOX, (0, 0, 0.05), FLOOR),
    ),
    "faces that overlap in part, with one corner of either": (
        reason.MANY,
        lambda: free(BOX, (0.06, 0.05, 0.05), PYRAMID_ON_ITS_TIP, k=2),
    ),
    "faces that overlap in part, of which one point is kept": (
        reason.MANY,
        lambda: free(BOX, (0.06, 0.05, 0.05), PYRAMID_ON_ITS_TIP),
    ),
    "faces that overlap in three corners, which are not all of either": (
        reason.MANY,
        lambda: free(BOX, (0, 0, 0.1), PRISM, k=2),
    ),
    "faces that cross without a corner": (
        reason.MANY,
        lambda: free(BAR_ACROSS, (0, 0, 0.1), BAR, k=4),
    ),
    "a point at a centre of curvature": (
        reason.MANY,
        lambda: free(POINT, ((0.3**2 - 0.1**2) / 0.3, 0, 0), Ellipsoid((0.3, 0.2, 0.1))),
    ),
    "a point at a box's corner": (reason.NO_NORMAL, lambda: free(POINT, (0.1, 0.1, 0.05), BOX)),
    "a normal as far from two axes of the world": (
        reason.TANGENTS,
        lambda: ball_on_ball((1.0, 1.0 + 0.1 * TIED, 2.0)),
    ),
    "a cylinder that stands upright on its rim": (
        reason.RIM,
        lambda: free(Cylinder(0.04, 0.06), (0, 0, 0.06), FLOOR, k=4),
    ),
    # Depths that tie by more than a step is refused for.
    "a point as deep below two faces": (
        reason.SURFACES,
        lambda: free(POINT, (0.09, 0, 0.04 + 4e-12), BOX),
    ),
    "a box over an edge": (
        reason.CROSSING,
        lambda: free(Box((0.05, 0.04, 0.03)), (0.08, 0, 0.08), BOX, k=4),
    ),
    "capsules that lie across each other": (
        reason.CROSSING,
        lambda: free(PILL, (0.0599, 0, 0), PILL, k=2, rpy=(np.pi / 2, 0, 0)),
    ),
}


@pytest.mark.parametrize(("kind", "scene"), KINKS.values(), ids=KINKS)
def test_a_constructed_kink_is_named(kind, scene):
    simulator, q = scene()
    found, kinds = verdict(simulator, q, DOWN)
    assert kind in kinds, [str(why) for why in found.reasons]
    assert not found.differentiable
    assert np.isnan(found.dq_dq).all()
    assert np.isfinite(found.dq_dtau).any()
    assert all(why.where[0].startswith("c0") for why in found.reasons if why.kind == kind)


NO_KINKS = {
    "of five points the fourth is a little higher": (
        lambda: free(five_points(10 * TIED), (0, 0, 0), FLOOR, k=3)
    ),
    "of five points those that are level are kept": (
        lambda: free(five_points(), (0, 0, 0), FLOOR, k=4)
    ),
    "all corners of the upper face": lambda: free(BOX, (0, 0, 0.1), SLAB, k=4),
    "all corners of the lower face": lambda: free(SLAB, (0, 0, 0.1), BOX, k=4),
    "all corners of a mesh's face": lambda: free(PYRAMID, (0, 0, 0.05), SLAB, k=4),
    "a normal nearly as far from two axes": lambda: ball_on_ball((1.0, 1.0 + 10 * TIED, 2.0)),
    "a normal along an axis": lambda: ball_on_ball((0.0, 0.0, 1.0)),
    "a cylinder that stands upright and can only rise": lambda: on_a_rail(
        FLOOR, Cylinder(0.04, 0.06), (0, 0, 0.06), 4
    ),
    "faces that overlap in part and can only come nearer": (
        lambda: on_a_rail(PYRAMID_ON_ITS_TIP, BOX, (0.06, 0.05, 0.05), 1)
    ),
    "a box that lies flat, but far away": lambda: free(BOX, (0, 0, 0.5), FLOOR),
}


@pytest.mark.parametrize("scene", NO_KINKS.values(), ids=NO_KINKS)
def test_what_is_nearly_a_kink_is_none(scene):
    simulator, q = scene()
    found, kinds = verdict(simulator, q, DOWN[: simulator.system.n_v])
    assert kinds == set()
    assert found.differentiable


@pytest.mark.parametrize(("distance", "kinds"), [(1e-9, 1), (1e-7, 1), (1e-5, 0)])
def test_so_near_to_an_edge_that_float64_does_not_know_the_normal(distance, kinds):
    # Places are right to 1e-16 m, and the normal to that over the distance.
    at = np.array([0.02, 0.1, 0.05]) + distance * np.array([0.0, 0.6, 0.8])
    simulator, q = free(POINT, at, BOX)
    found, named = verdict(simulator, q, DOWN)
    assert named == ({reason.NO_NORMAL} if kinds else set())
    assert np.isnan(found.dq_dq).all() == np.isnan(found.dq_dtau).all() == bool(kinds)


@pytest.mark.parametrize(("tilt", "kind"), [(1e-8, True), (3e-6, True), (1e-4, False)])
def test_a_rim_so_level_that_float64_does_not_know_its_lowest_point(tilt, kind):
    simulator, q = free(Cylinder(0.04, 0.06), (0, 0, 0.06), FLOOR, k=4, rpy=(tilt, 0, 0))
    found, named = verdict(simulator, q, DOWN)
    assert (reason.RIM in named) == kind
    assert np.isnan(found.dq_dtau).all() == kind


TURNING = {
    "a wheel": (Body("hand", WHEEL, actuated=("turn",)), [1, 0], [-1, 0], [0, 1]),
    "a puck": (
        Body.of_shape("hand", Sphere(0.05), 0.3, base="planar", actuated=["base"]),
        [0, 0, 1, 0], [0.1, 0, -1, 0], [0.1, 0, 0, 1],
    ),
    "a floating hand": (
        Body.of_shape("hand", Sphere(0.05), 0.3, actuated=["base"]),
        [0, 0, 0, 0, 0, 0, 1], [0, 0, 0.1, 0, 0.6, 0.8, 0], [0, 0, 0.1, 0, 0.6, 0, 0.8],
    ),
}  # fmt: skip
"""A body, where it is, a target half a turn away and another one."""


@pytest.mark.parametrize("turning", TURNING)
def test_a_target_half_a_turn_away_is_named(turning):
    body, q, half, other = TURNING[turning]
    # A body that is not actuated has no target.
    system = System([body, Body.of_shape("ball", Sphere(0.05), 0.3)])
    simulator = Simulator(system, [], h=H, K_q=np.eye(system.n_a))
    q = system.with_actuated(system.q_start, q)
    found = derivatives(simulator, q, half)
    assert [(why.kind, why.where[0].partition("/")[0]) for why in found.reasons] == [
        (reason.HALF_TURN, "hand")
    ]
    assert np.isnan(found.dq_dq_bar_a).all()
    assert derivatives(simulator, q, other).differentiable


@pytest.mark.parametrize("mu", [(0.0, 0.01), (0.5, 0.0)])
def test_friction_of_zero_has_no_derivative_and_all_else_has(mu):
    simulator, q = free(Sphere(0.05), (0, 0, 0.05), FLOOR, mu=mu)
    found, kinds = verdict(simulator, q, DOWN)
    assert kinds == {reason.ZERO_FRICTION}
    assert found.differentiable
    assert np.isfinite(found.dq_dq).all()
    by_friction = np.isnan([found.dq_dmu_v, found.dq_dmu_omega]).all(axis=(1, 2))
    assert by_friction.tolist() == [coefficient == 0 for coefficient in mu]
