"""Servos whose force follows an activation: at rest that of a filter is its control."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import InputError

SLIDER = """<mujoco><worldbody><body name="b"><joint name="j" type="slide" axis="1 0 0"/>
<geom size="0.05" mass="1"/></body></worldbody><actuator>{}</actuator></mujoco>"""
POSITION = '<position name="a" joint="j" kp="100" timeconst="0.3"{}/>'
GENERAL = (
    '<general name="a" joint="j" dyntype="{}" dynprm="0.3" gainprm="100" biastype="affine" '
    'biasprm="0 -100 0"{}/>'
)
RANGE = ' actlimited="true" actrange="-0.1 0.1"'
SERVOS = {
    "timeconst": (POSITION.format(""), 0.2),
    "filter": (GENERAL.format("filter", ""), 0.2),
    "exact filter": (GENERAL.format("filterexact", ""), 0.2),
    "range of the activation": (GENERAL.format("filter", RANGE), 0.1),
    "range of the control": (POSITION.format(' ctrlrange="0 0.15"'), 0.15),
    "no filter": ('<position name="a" joint="j" kp="100"/>', 0.2),
}


def run(folder, actuator):
    model = mujoco.MjModel.from_xml_string(SLIDER.format(actuator))
    (folder / "t.csv").write_text("t,a\n0,0\n0.1,0.2\n")
    scene = qr.mujoco_scenario(model, targets=folder / "t.csv", steps=60)
    return scene.run(progress=False)


@pytest.mark.parametrize(("actuator", "end"), SERVOS.values(), ids=SERVOS)
def test_a_servo_behind_a_filter_reaches_its_control(tmp_path, actuator, end):
    assert run(tmp_path, actuator)["q"][-1, 0] == pytest.approx(end, abs=1e-9)


def test_targets_of_an_integrator_are_refused_by_name(tmp_path):
    velocity = '<intvelocity name="a" joint="j" kp="100" actrange="-1 1"/>'
    with pytest.raises(InputError, match=r"targets\.a: is the control of an actuator that integr"):
        run(tmp_path, velocity)


def test_mujoco_itself_ends_where_the_run_does():
    model = mujoco.MjModel.from_xml_string(SLIDER.format(POSITION.format(' kv="20"')))
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.2
    for _ in range(5000):
        mujoco.mj_step(model, data)
    assert np.allclose(data.qpos, 0.2, atol=1e-6)
