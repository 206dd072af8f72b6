"""What penetration does to forces, and what is said of it."""

import mujoco
import pytest

from quasistatic_ref.optional.guests.mujoco import mujoco_step
from quasistatic_ref.solve.solve import solve_step

H, GRAVITY, MASS, K = 0.01, 9.81, 2.0, 500.0
SERVO = f'<actuator><position joint="z" kp="{K}"/></actuator>'


def ball(joint, depth, more="", how=""):
    """A ball of 0.1 m that is so deep in a floor."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><size memory="1M"/><worldbody>
        <geom name="floor" type="plane" size="1 1 1" {how}/>
        <body name="ball" pos="0 0 {0.1 - depth}">{joint}
        <geom name="ball" size=".1" mass="{MASS}" {how}/></body></worldbody>{more}</mujoco>"""
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


FREE = "<freejoint/>"
SLIDE = '<joint name="z" type="slide" axis="0 0 1" damping="40"/>'


@pytest.mark.parametrize("depth", [0.0, 1e-4, GRAVITY * H**2, 5e-3])
@pytest.mark.parametrize("springs", [0.0, K])
def test_a_depth_that_is_closed_adds_a_force_and_one_that_is_not_none(depth, springs):
    """N = m g; to close it, a body moves by the depth: N = m g + m depth / h^2.

    A servo, whose target is where it is, gives way by the depth: N = m g + k depth.
    """
    model, data = ball(SLIDE, depth, SERVO if springs else "")
    closed, _ = mujoco_step(model, data, H)
    as_is, _ = mujoco_step(model, data, H, depth="as is")
    added = depth * (springs or MASS / H**2)
    assert solve_step(closed).wrench[0, 2] == pytest.approx(MASS * GRAVITY, rel=1e-12)
    assert solve_step(as_is).wrench[0, 2] == pytest.approx(MASS * GRAVITY + added, rel=1e-12)


AT_ITS_RANGE = {
    "of the actuator": ("", "", '<position joint="x" kp="9" forcerange="-1 1"/>'),
    "of the joint": ('actuatorfrcrange="-1 1"', "", '<position joint="x" kp="9"/>'),
    "of the tendon": ("", 'actuatorfrcrange="-1 1"', '<position tendon="t" kp="9"/>'),
}


@pytest.mark.parametrize("limit", AT_ITS_RANGE)
def test_a_servo_at_the_end_of_its_range_is_a_force_and_no_spring(limit):
    """Targets of 0.1 m and 1 m, of 9 N/m, and at most 1 N: then x = h^2 f / m."""
    joint, tendon, servo = AT_ITS_RANGE[limit]
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body><joint name="x" type="slide" axis="1 0 0" {joint}/>
        <geom size=".1" mass="{MASS}"/></body></worldbody><tendon><fixed name="t" {tendon}>
        <joint joint="x" coef="1"/></fixed></tendon><actuator>{servo}</actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    for target, moves in ((0.1, 0.1), (1.0, H**2 / MASS)):
        data.ctrl[0] = target
        step, _ = mujoco_step(model, data, H)
        assert solve_step(step).delta_q == pytest.approx([moves])
