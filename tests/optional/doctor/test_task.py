"""Fillers in the sentence of idle contacts, and runs of MuJoCo scenes without targets."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import Targets
from quasistatic_ref.simulate.target import JointTrack

HAND = """<mujoco><worldbody><geom name="floor" type="plane" size="1 1 .1"/>
<body name="finger" pos="{at} 0 0.05"><joint name="slide" type="slide" axis="1 0 0"/>
<geom name="tip" type="box" size="0.02 0.02 0.02" mass="0.1"/></body>
<body name="box" pos="0 0 0.05"><freejoint/>
<geom name="box" type="box" size="0.05 0.05 0.05" mass="1"/></body></worldbody>
<actuator><position name="slide" joint="slide" kp="100"/></actuator></mujoco>"""


@pytest.mark.parametrize(
    ("at", "words"),
    [(-0.4, "none comes near enough to have a distance"), (-0.1, "is 28.2 mm apart")],
    ids=["beyond the margin", "within it"],
)
def test_a_filler_is_no_distance_of_idle_contacts(at, words):
    model = mujoco.MjModel.from_xml_string(HAND.format(at=at))
    scene = qr.mujoco_scenario(model, h=0.01, margin=0.1)
    (joint,) = [one for one in scene.system.joints if one.actuated]
    start = scene.system.q_start
    track = JointTrack(joint, np.array([0.0, 0.1]), np.array([[0.0], [0.002]]))
    targets = Targets(start[: scene.system.n_q_a], [track])
    run = qr.rollout(scene.simulator(), start, targets, 10, progress=False)
    (found,) = [one for one in run.findings if one.name == "idle-contacts"]
    assert words in found.cause
    assert "e+0" not in found.sentence


def test_a_mujoco_scene_may_be_run_without_targets():
    """To see how it stands: what is missing is said, and is no grave mistake."""
    run = qr.mujoco_scenario(mujoco.MjModel.from_xml_string(HAND.format(at=-0.4)), steps=3)
    (found,) = run.run(progress=False).findings
    assert (found.name, found.grave) == ("no-motion", False)
    assert "--targets" in found.remedy
    assert "contacts." not in found.sentence
