"""Own linear rows, joint friction, limits and MuJoCo scenes by DAQP: equal bits, no CVXPY."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from tests.helpers import first_step
from tests.processes import printed_text

STEPS = 4
TABLES = {
    "joint_limits": ["bodies.near.joint_limits=urdf"],
    "joint_friction": ["bodies.near.joint_friction.close_left=0.3"],
}
SCENE = """<mujoco><option cone="pyramidal"/><worldbody>
<geom type="plane" size="1 1 1" condim="4"/>
<body pos="0 0 .049"><joint name="push" type="slide" axis="1 0 0" range="-1 .003" limited="true"
frictionloss=".5"/><geom type="box" size=".02 .1 .04" mass=".5" condim="4"/>
<body name="rod" pos="0 0 .1"><joint axis="0 1 0"/>
<geom size=".01" pos=".1 0 0" contype="0" conaffinity="0" mass=".1"/></body></body>
<body pos=".05 0 .03"><freejoint/><geom type="box" size=".03 .03 .03" mass=".1" condim="4"/></body>
</worldbody><equality><connect body1="rod" anchor=".1 0 0"/></equality>
<actuator><position name="push" joint="push" kp="500"/></actuator></mujoco>"""
WALLS = np.eye(6)[2] * [[1.0], [-1.0]]


def run_of(name, fast):
    """A run of some steps, all of them proved."""
    if name == "MuJoCo":
        model = mujoco.MjModel.from_xml_string(SCENE)
        one = qr.mujoco_scenario(model, targets=lambda t: {"push": 0.1 * t}, fast=fast)
    else:
        one = qr.load_scenario("two_finger_pinch", TABLES.get(name, []), fast=fast)
    row = qr.Extra(("guide",), np.ones((1, one.system.n_v)), [1e-6])
    guide = (lambda q: qr.Extension(rows=row)) if name == "guide" else None
    run = qr.rollout(one.simulator(guide), one.system.q_start, one.target, STEPS)
    assert set(run.certificate) == {"exact"}
    return run


def check_walls():
    """Walls that leave no room are proved to, though nothing else is."""
    one = qr.load_scenario("sphere_spin", ["solver.certify=off"], fast=True)
    walls = qr.Extra(("up", "down"), WALLS, np.full(2, 1e-3))
    simulator = one.simulator(lambda q: qr.Extension(rows=walls))
    with pytest.raises(qr.StepInfeasible):
        first_step(one, simulator)


@pytest.mark.parametrize("name", ["guide", *TABLES, "MuJoCo"])
def test_steps_with_rows_of_their_own_have_equal_bits(name):
    plain, fast = (run_of(name, speed) for speed in (False, True))
    assert fast.q.tobytes() == plain.q.tobytes()
    assert (plain.header.backend, fast.header.backend) == ("clarabel", "daqp")
    assert fast.header.extra == plain.header.extra != ()


def test_fast_steps_with_rows_of_their_own_do_without_cvxpy():
    """Nor is a second solver asked whether walls leave no room, of which there is a proof."""
    said = printed_text(
        "import sys",
        "sys.modules['cvxpy'] = None",
        "from tests.optional.daqp.test_own_rows import TABLES, check_walls, run_of",
        "for name in ('guide', *TABLES, 'MuJoCo'):",
        "    assert run_of(name, True).header.backend == 'daqp'",
        "check_walls()",
    )
    assert said == ""
