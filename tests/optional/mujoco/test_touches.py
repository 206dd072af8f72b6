"""What penetration does to forces, and what is said of it."""

import pytest

from tests.optional.mujoco.models import GRAVITY, H, mjcf, moved, posed

MASS, K = 2.0, 500.0
SERVO = f'<actuator><position joint="z" kp="{K}"/></actuator>'


@pytest.mark.parametrize("depth", [0.0, 1e-4, GRAVITY * H**2, 5e-3])
@pytest.mark.parametrize("springs", [0.0, K])
def test_a_depth_that_is_closed_adds_a_force_and_one_that_is_not_none(depth, springs):
    """N = m g; to close it, a body moves by the depth: N = m g + m depth / h^2.

    A servo, whose target is where it is, gives way by the depth: N = m g + k depth.
    """
    world = f"""<geom type="plane" size="1 1 1"/><body pos="0 0 {0.1 - depth}">
    <joint name="z" type="slide" axis="0 0 1" damping="40"/>
    <geom size=".1" mass="{MASS}"/></body>"""
    state = posed(mjcf(world, SERVO if springs else ""))
    added = depth * (springs or MASS / H**2)
    for name, force in (("closed", MASS * GRAVITY), ("as is", MASS * GRAVITY + added)):
        assert moved(*state, name).answer.wrench[0, 2] == pytest.approx(force, rel=1e-12)


AT_ITS_RANGE = {
    "of the actuator": ("", "", '<position joint="x" kp="9" forcerange="-1 1"/>'),
    "of the joint": ('actuatorfrcrange="-1 1"', "", '<position joint="x" kp="9"/>'),
    "of the tendon": ("", 'actuatorfrcrange="-1 1"', '<position tendon="t" kp="9"/>'),
}


@pytest.mark.parametrize("limit", AT_ITS_RANGE)
def test_a_servo_at_the_end_of_its_range_is_a_force_and_no_spring(limit):
    """Targets of 0.1 m and 1 m, of 9 N/m, and at most 1 N: then x = h^2 f / m."""
    joint, tendon, servo = AT_ITS_RANGE[limit]
    world = f"""<body><joint name="x" type="slide" axis="1 0 0" {joint}/>
    <geom size=".1" mass="{MASS}"/></body>"""
    rest = f"""<tendon><fixed name="t" {tendon}><joint joint="x" coef="1"/></fixed></tendon>
    <actuator>{servo}</actuator>"""
    for target, moves in ((0.1, 0.1), (1.0, H**2 / MASS)):
        assert moved(*posed(mjcf(world, rest), ctrl=target)).by == pytest.approx([moves])
