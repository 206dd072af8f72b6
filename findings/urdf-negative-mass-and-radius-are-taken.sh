#!/usr/bin/env bash
# pinocchio 4.1.0 with its URDF reader urdfdom: a link of negative mass, a sphere of negative radius, a hinge whose axis is 0.
# Expected: an error for each. What comes: a model with each of these numbers in it, and no word.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin


def read(mass="1", radius="0.1", axis="0 0 1"):
    text = (
        f'<robot name="r"><link name="base"/><link name="tip"><inertial><mass value="{mass}"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><geometry><sphere radius="{radius}"/></geometry></collision></link>'
        '<joint name="j" type="continuous"><parent link="base"/><child link="tip"/>'
        f'<axis xyz="{axis}"/></joint></robot>'
    )
    model = pin.buildModelFromXML(text)
    return model, pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)


mass = read(mass="-1")[0].inertias[1].mass
radius = read(radius="-0.1")[1].geometryObjects[0].geometry.radius
model = read(axis="0 0 0")[0]
J = np.ravel(pin.computeJointJacobian(model, model.createData(), pin.neutral(model), 1))
print("mass:", mass)
print("radius:", radius)
print("motion of the hinge about axis 0:", J)
assert mass == -1.0
assert radius == -0.1
assert not np.allclose(np.linalg.norm(J[3:]), 1.0)
PYTHON
