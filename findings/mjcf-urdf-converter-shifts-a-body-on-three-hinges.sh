#!/usr/bin/env bash
# mjcf_urdf_simple_converter 0.7.3, beside MuJoCo 4.0.0 and pinocchio 4.1.0: a body with one to three hinges about z, y and x, as
# a wrist has them, that all go through a point 0.3 m off the body's origin.
# Expected: the tip where MuJoCo has it, at zero and at other angles. What comes: so for one and two hinges; with three the body
# is 0.3 m off already at zero, since the places of the hinges before are added up and then taken off.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet mjcf-urdf-simple-converter==0.7.3 mujoco==4.0.0 pin==4.1.0 \
  numpy==2.4.6 scipy==1.17.1
cd "$folder"

venv/bin/python - << 'PYTHON'
import mujoco
import numpy as np
import pinocchio
from mjcf_urdf_simple_converter import convert

AXES = ("0 0 1", "0 1 0", "1 0 0")
ANGLES = np.array([0.4, 0.5, 0.6])
for count, away in ((1, 0.0), (2, 0.0), (3, 0.3)):
    hinges = "".join(
        f'<joint name="hinge{i}" type="hinge" axis="{axis}" pos="0.3 0 0" range="-180 180"/>' for i, axis in enumerate(AXES[:count])
    )
    with open("hand.xml", "w", encoding="ascii") as file:
        file.write(
            f'<mujoco><worldbody><body name="hand" pos="0 0 1">{hinges}<geom size="0.1"/>'
            '<body name="tip" pos="1 0 0"><geom size="0.1"/></body></body></worldbody></mujoco>'
        )
    convert("hand.xml", "hand.urdf")
    model = mujoco.MjModel.from_xml_path("hand.xml")
    data = mujoco.MjData(model)
    other = pinocchio.buildModelFromUrdf("hand.urdf")
    memory = other.createData()
    for angles in (np.zeros(count), ANGLES[:count]):
        data.qpos[:] = angles
        mujoco.mj_forward(model, data)
        pinocchio.framesForwardKinematics(other, memory, angles)
        tip = memory.oMf[other.getFrameId("tip")].translation
        due = data.body("tip").xpos
        print(f"{count} hinges at {angles}: MuJoCo {due.round(3)}, URDF {tip.round(3)}, {np.linalg.norm(tip - due):.2f} m away")
        assert np.isclose(np.linalg.norm(tip - due), away, atol=1e-6)
PYTHON
