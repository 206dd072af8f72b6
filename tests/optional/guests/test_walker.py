"""A walker as a state of MuJoCo and as a URDF: one step, where both see the same contacts."""

import mujoco
import numpy as np
import pytest

from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.mujoco import mujoco_step
from quasistatic_ref.optional.guests.still import still
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step

WALKER = """<mujoco><compiler angle="radian" eulerseq="XYZ"/><size memory="1M"/>
<default><geom mass="0" friction=".6 .03 0" condim="4" contype="2" conaffinity="0"/></default>
<worldbody><geom name="floor" type="plane" size="9 9 1" conaffinity="2" gap=".01"/>
<body name="trunk" pos="{pose}" euler="{rpy}"><freejoint/>
<inertial pos=".01 .02 0" mass="3" diaginertia=".02 .03 .04"/>
<body name="left" pos=".1 .1 0"><joint name="left" axis="0 1 0"/>
<inertial pos=".1 0 0" mass=".5" diaginertia=".001 .002 .003"/>
<geom name="left" size="{left}" pos=".3 0 -.3"/></body>
<body name="right" pos="-.1 -.1 0"><joint name="right" axis="1 .2 0"/>
<inertial pos="0 .1 0" mass=".4" diaginertia=".001 .002 .003"/>
<geom name="right" size="{right}" pos="0 .3 -.3"/></body>
<body name="tail"><joint name="tail" type="slide" axis=".3 0 1"/>
<inertial pos="-.1 0 0" mass=".4" diaginertia=".001 .002 .003"/>
<geom name="tail" size="{tail}" pos="-.3 0 -.3"/></body>
</body></worldbody>
<actuator><position joint="left" kp="300"/><position joint="right" kp="200"/></actuator></mujoco>"""
URDF = """<robot name="walker"><link name="trunk"><inertial><origin xyz=".01 .02 0"/>
<mass value="3"/><inertia ixx=".02" iyy=".03" izz=".04" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="left"><inertial><origin xyz=".1 0 0"/><mass value=".5"/>
<inertia ixx=".001" iyy=".002" izz=".003" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz=".3 0 -.3"/><geometry><sphere radius="{left}"/></geometry></collision>
</link>
<link name="right"><inertial><origin xyz="0 .1 0"/><mass value=".4"/>
<inertia ixx=".001" iyy=".002" izz=".003" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 .3 -.3"/><geometry><sphere radius="{right}"/></geometry></collision>
</link>
<link name="tail"><inertial><origin xyz="-.1 0 0"/><mass value=".4"/>
<inertia ixx=".001" iyy=".002" izz=".003" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="-.3 0 -.3"/><geometry><sphere radius="{tail}"/></geometry></collision>
</link>
<joint name="left" type="continuous"><origin xyz=".1 .1 0"/><parent link="trunk"/>
<child link="left"/><axis xyz="0 1 0"/></joint>
<joint name="right" type="continuous"><origin xyz="-.1 -.1 0"/><parent link="trunk"/>
<child link="right"/><axis xyz="1 .2 0"/></joint>
<joint name="tail" type="prismatic"><parent link="trunk"/><child link="tail"/>
<axis xyz=".3 0 1"/><limit effort="0" velocity="0"/></joint></robot>"""
SCENE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 1
[bodies.walker]
urdf = "walker.urdf"
base = "floating"
actuated = ["left", "right"]
gravity_compensated = false
K_q = {{ left = 300, right = 200 }}
pose = {{ xyz = {xyz}, rpy = {rpy} }}
positions = {{ left = {q[0]}, right = {q[1]}, tail = {q[2]} }}
[[bodies.walker.targets]]
t = 0.0
left = {bar[0]}
right = {bar[1]}
[shapes.floor]
halfspace = {{ normal = [0, 0, 1], offset = 0 }}
[contacts.feet]
alpha = "floor"
beta = ["walker/left", "walker/right", "walker/tail"]
mu_v = 0.6
mu_omega = 0.03
rows = 6
k = 1
"""


JOINTS = ("left", "right", "tail")


def walker(seed, above, folder):
    """A random posture with three feet above the floor [m]: of MuJoCo, and in the folder."""
    random = np.random.default_rng(seed)
    q = random.uniform(-0.3, 0.3, 3)
    bar = q[:2] + random.uniform(-0.05, 0.05, 2)
    rpy = random.uniform(-0.2, 0.2, 3)
    xyz = np.array([0.2, 0.3, 0.6])
    sizes = dict.fromkeys(JOINTS, 0.1)
    for _ in ("where the feet are", "as large as they are high"):
        place = {
            "pose": " ".join(map(repr, xyz.tolist())),
            "rpy": " ".join(map(repr, rpy.tolist())),
        }
        radii = sizes
        model = mujoco.MjModel.from_xml_string(WALKER.format(**place, **radii))
        data = mujoco.MjData(model)
        data.qpos[7:] = q
        data.ctrl[:] = bar
        mujoco.mj_forward(model, data)
        sizes = {name: float(data.geom(name).xpos[2]) - above for name in sizes}
    (folder / "walker.urdf").write_text(URDF.format(**radii))
    (folder / "scene.toml").write_text(
        SCENE.format(xyz=xyz.tolist(), rpy=rpy.tolist(), q=q.tolist(), bar=bar.tolist())
    )
    return model, data


@pytest.mark.parametrize(("seed", "above"), [(0, 0.0), (1, 0.0), (2, 2e-4)])
def test_a_state_of_mujoco_steps_as_the_same_walker_from_a_urdf(seed, above, tmp_path):
    model, data = walker(seed, above, tmp_path)
    scenario = load_scenario(tmp_path / "scene.toml")
    step, coordinates = mujoco_step(model, data, 0.01)
    assert step.contacts.phi == pytest.approx([above] * 3, abs=1e-15)
    guest = coordinates.T @ solve_step(step).delta_q
    delta_q = scenario.run(progress=False).delta_q[0]
    moves = dict(zip((c.name for c in scenario.system.coordinates), delta_q, strict=True))
    ours = [moves[f"walker/base.{axis}"] for axis in ("x", "y", "z", "rx", "ry", "rz")]
    R = data.xmat[1].reshape(3, 3)
    ours = [*R @ ours[:3], *ours[3:], *(moves[f"walker/{name}"] for name in JOINTS)]
    assert guest == pytest.approx(np.array(ours), rel=0, abs=1e-9 * np.abs(guest).max())
    assert np.abs(guest).max() > 1e-5


@pytest.mark.parametrize("seed", range(3))
def test_mujocos_point_between_the_surfaces_makes_other_slips(seed, tmp_path):
    """The points at p -+ n phi / 2 add phi / 2 (n x t) . (omega_1 + omega_2) to those at p.

    Since v(p + r) = v(p) + omega x r, and t . (omega x n) = (n x t) . omega.
    """
    model, data = walker(seed, 0.02, tmp_path)
    model.geom_margin[:] = 0.05  # MuJoCo has rows for contacts within it
    mujoco.mj_forward(model, data)
    state = still(model, data)
    state.run()
    assert len(touches.listed(state)) == 3
    for _, touch in touches.listed(state):
        ours = touches.jacobian(state, touch)
        first = touch.efc_address
        theirs = data.efc_J.reshape(-1, model.nv)[first : first + 6]
        turns = np.zeros((2, 3, model.nv))
        for turn, geom in zip(turns, touch.geom, strict=True):
            mujoco.mj_jacGeom(model, data, None, turn, geom)
        n, *tangents = touch.frame.reshape(3, 3)
        assert n @ ours[:3] == pytest.approx((theirs[0] + theirs[1]) / 2, abs=1e-15)
        assert ours[3] == pytest.approx(
            (theirs[4] - theirs[5]) / (2 * touch.friction[2]), abs=1e-14
        )
        for k, t in enumerate(tangents):
            row = (theirs[2 * k] - theirs[2 * k + 1]) / (2 * touch.friction[k])
            other = touch.dist / 2 * np.cross(n, t) @ turns.sum(axis=0)
            assert t @ ours[:3] - row == pytest.approx(other, abs=1e-15)
            assert np.abs(other).max() > 1e-3
