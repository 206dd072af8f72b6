#!/usr/bin/env bash
# kinpy 0.6.1: the tip of an arm of 1 m on a hinge, in MJCF, whose body is turned by 90 degrees, written as quat, euler, axisangle,
# xyaxes and zaxis, five ways of one pose; beside MuJoCo 4.0.0, which made the format.
# Expected: the same tip from all five, or an error. What comes: so for quat; the four others are dropped without a word, and
# the tip is 1.24 m away.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet kinpy==0.6.1 mujoco==4.0.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import kinpy
import mujoco
import numpy as np

ANGLE = 0.5
# A quarter turn about y, in each of the format's spellings.
SPELLINGS = {
    "quat": "1 0 1 0",
    "euler": "0 90 0",
    "axisangle": "0 1 0 90",
    "xyaxes": "0 0 -1 0 1 0",
    "zaxis": "1 0 0",
}
TRUE = np.array([0.0, np.sin(ANGLE), -np.cos(ANGLE)])

for attribute, numbers in SPELLINGS.items():
    xml = (
        f'<mujoco><worldbody><body name="arm" {attribute}="{numbers}"><joint name="hinge" type="hinge" axis="0 0 1"/>'
        '<geom type="sphere" size="0.1"/><body name="tip" pos="1 0 0"><geom type="sphere" size="0.1"/></body></body>'
        "</worldbody></mujoco>"
    )
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qpos[:] = ANGLE
    mujoco.mj_forward(model, data)
    tip = kinpy.build_chain_from_mjcf(xml).forward_kinematics({"hinge": ANGLE})["tip"].pos
    away = np.linalg.norm(tip - TRUE)
    print(f"{attribute}: MuJoCo {data.body('tip').xpos.round(3)}, kinpy {tip.round(3)}, {away:.2f} m away")
    assert np.allclose(data.body("tip").xpos, TRUE)
    if attribute == "quat":
        assert away < 1e-6
    else:
        assert np.allclose(tip, [np.cos(ANGLE), np.sin(ANGLE), 0.0])
        assert away > 1.2
PYTHON
