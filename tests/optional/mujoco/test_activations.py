"""Servos whose force follows an activation, and the targets that move one."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import ModelError
from tests.helpers import Place
from tests.optional.mujoco.models import model_of, posed

SLIDER = """<mujoco><worldbody><body name="b"><joint name="j" type="slide" axis="1 0 0"/>
<geom size="0.05" mass="1"/></body></worldbody><actuator>{}</actuator></mujoco>"""
POSITION = '<position name="a" joint="j" kp="100" timeconst="0.3"{}/>'
GENERAL = (
    '<general name="a" joint="j" dyntype="{}" dynprm="0.3" gainprm="100" biastype="affine" '
    'biasprm="0 -100 0"{}/>'
)
RANGE = ' actlimited="true" actrange="-0.1 0.1"'
INTEGRATED = '<intvelocity name="a" joint="j" kp="100" actrange="{}"{}/>'
BEYOND = ' ctrlrange="0.5 0.6"'
"""No target of the table is within."""
SERVOS = {
    "timeconst": (POSITION.format(""), 0.2),
    "filter": (GENERAL.format("filter", ""), 0.2),
    "range of the activation": (GENERAL.format("filter", RANGE), 0.1),
    "range of the control": (POSITION.format(' ctrlrange="0 0.15"'), 0.15),
    "no filter": ('<position name="a" joint="j" kp="100"/>', 0.2),
    # h times a control of 0.02, 0.04, ... 0.2, and of 0.2 in each of the 50 steps after them
    "integrator": (INTEGRATED.format("-1 1", ""), 0.01 * (1.1 + 50 * 0.2)),
    "range of an integrator": (INTEGRATED.format("-1 0.03", ""), 0.03),
    "range of an integrator's control": (INTEGRATED.format("-1 1", BEYOND), 0.01 * 60 * 0.5),
}


def run(folder, actuator):
    model = model_of(SLIDER.format(actuator))
    (folder / "t.csv").write_text("t,a\n0,0\n0.1,0.2\n")
    return qr.mujoco_scenario(model, targets=Place(folder / "t.csv"), steps=60, fast=True).run()


@pytest.mark.parametrize(("actuator", "end"), SERVOS.values(), ids=SERVOS)
def test_a_servo_with_an_activation_reaches_its_control(tmp_path, actuator, end):
    assert run(tmp_path, actuator)["q"][-1, 0] == pytest.approx(end, abs=1e-9)


def test_an_integrator_starts_from_the_activation_of_a_state_and_runs_twice_alike():
    state = posed(SLIDER.format(INTEGRATED.format("-1 1", "")), act=0.5)
    scene = qr.mujoco_scenario(*state, targets=lambda t: {"a": -0.1}, steps=20, fast=True)
    first, second = (scene.run()["q"] for _ in range(2))
    assert first[-1, 0] == pytest.approx(0.5 - 0.01 * 20 * 0.1, abs=1e-9)
    assert np.array_equal(first, second)


def test_a_muscle_is_refused_by_name():
    muscle = '<muscle name="m" joint="j" lengthrange="-1 1"/>'
    with pytest.raises(ModelError, match=r"actuator\[m\]\.dyntype: has a lag between control"):
        qr.mujoco_scenario(model_of(SLIDER.format(muscle)))


def test_a_column_that_changes_no_force_is_a_finding(tmp_path):
    findings = run(tmp_path, INTEGRATED.format("-1 1", BEYOND)).findings
    assert [one.name for one in findings] == ["target-without-effect"]
    assert "drive another actuator than a" in findings[0].remedy
    assert not run(tmp_path, INTEGRATED.format("-1 1", "")).findings
