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


def scene(name, fast):
    """A simulator, its targets (t, q) and where it starts."""
    if name == "MuJoCo":
        model = mujoco.MjModel.from_xml_string(SCENE)
        one = qr.mujoco_scenario(model, targets=lambda t: {"push": 0.1 * t}, fast=fast)
        return one.simulator(), one.drive, one.system.q_start
    one = qr.load_scenario("two_finger_pinch", TABLES.get(name, []), fast=fast)
    n_v = one.system.n_v
    row = qr.Extra(("guide",), np.ones((1, n_v)), np.array([1e-6]))
    guide = (lambda q: qr.Extension(rows=row)) if name == "guide" else None
    return one.simulator(guide), lambda t, q: one.targets(t), one.system.q_start


def bits_of_steps(name, fast):
    """Q of each step in hexadecimal; by which interface, and how many rows of its own."""
    simulator, target, q = scene(name, fast)
    found = []
    for k in range(STEPS):
        result = simulator.step(q, target(simulator.h * (k + 1), q))
        solution = result.solution
        q = result.q
        assert solution.certificate.kind == "exact"
        found.append(q.tobytes().hex())
    return found, solution.statistics.interface, len(result.step.extra.names)


def proof_of_walls():
    """What is raised of a step between walls that leave no room, of which nothing is proved."""
    one = qr.load_scenario("sphere_spin", ["solver.certify=off"], fast=True)
    walls = qr.Extra(("up", "down"), WALLS, np.full(2, 1e-3))
    simulator = one.simulator(lambda q: qr.Extension(rows=walls))
    with pytest.raises(qr.StepNotSolved) as raised:
        first_step(one, simulator)
    return type(raised.value).__name__


@pytest.mark.parametrize("name", ["guide", *TABLES, "MuJoCo"])
def test_steps_with_rows_of_their_own_have_equal_bits(name):
    plain, interface, rows = bits_of_steps(name, fast=False)
    fast, native, fast_rows = bits_of_steps(name, fast=True)
    assert fast == plain
    assert (interface, native) == ("cvxpy", "native")
    assert rows == fast_rows > 0


def test_fast_steps_with_rows_of_their_own_do_without_cvxpy():
    """Nor is a second solver asked whether walls leave no room, of which there is a proof."""
    said = printed_text(
        "import sys",
        "sys.modules['cvxpy'] = None",
        "from tests.optional.daqp.test_own_rows import TABLES, bits_of_steps, proof_of_walls",
        "names = 'guide', *TABLES, 'MuJoCo'",
        "print([bits_of_steps(name, True)[1] for name in names], proof_of_walls())",
    )
    assert said == f"{['native'] * 4} StepInfeasible"
