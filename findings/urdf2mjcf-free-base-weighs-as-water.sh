#!/usr/bin/env bash
# urdf2mjcf 0.2.39: a base of 1.5 kg, a box of 0.2 x 0.4 x 0.6 m that is mostly air, with an arm of 2 kg, both with all of <inertial>,
# turned into MJCF as it comes and with floating_base off; what MuJoCo 4.0.0 makes of each file.
# Expected: 1.5 and 2 kg, and the centres of mass of the URDF. What comes: so with floating_base off. As it comes, the base gets a
# free joint and loses <inertial>, so that MuJoCo fills its collision box with water: 48 kg, with the centre of mass in the middle of
# the box, and 32 times the largest moment of inertia. A base without a collision is refused by MuJoCo, as it weighs nothing.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet urdf2mjcf==0.2.39 mujoco==4.0.0 numpy==2.4.6
cd "$folder"

venv/bin/python - << 'PYTHON'
import mujoco
import numpy as np
from urdf2mjcf.convert import convert_urdf_to_mjcf
from urdf2mjcf.model import ConversionMetadata

SIZE = np.array([0.2, 0.4, 0.6])
CENTRE = np.array([0.05, 0.0, 0.1])
WATER = 1000.0
INERTIA = '<inertia ixx="0.065" iyy="0.05" izz="0.025" ixy="0" ixz="0" iyz="0"/>'


def link(name, mass, centre, shape):
    """One link of a URDF."""
    centre = " ".join(map(str, centre))
    return (
        f'<link name="{name}"><inertial><origin xyz="{centre}" rpy="0 0 0"/><mass value="{mass}"/>{INERTIA}</inertial>'
        f"<collision><geometry>{shape}</geometry></collision></link>"
    )


with open("robot.urdf", "w", encoding="ascii") as file:
    file.write(
        '<robot name="robot">'
        + link("base", 1.5, CENTRE, f'<box size="{" ".join(map(str, SIZE))}"/>')
        + link("arm", 2.0, [0.1, 0.0, 0.0], '<sphere radius="0.1"/>')
        + '<joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.5" rpy="0 0 0"/>'
        '<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="9"/></joint></robot>'
    )


def convert(metadata):
    """MuJoCo's model of the converted file."""
    convert_urdf_to_mjcf("robot.urdf", "robot.xml", metadata=metadata)
    model = mujoco.MjModel.from_xml_path("robot.xml")
    base = model.body("base")
    print(
        f"masses {base.mass[0]:.2f} and {model.body('arm').mass[0]:.2f} kg, base's centre of mass {base.ipos} m, "
        f"inertia {base.inertia.round(4)} kg m^2, {model.nv} degrees of freedom"
    )
    return model


fixed = convert(ConversionMetadata(floating_base=False))
assert np.allclose(fixed.body("base").mass, 1.5)
assert np.allclose(fixed.body("base").ipos, CENTRE)
free = convert(None)
assert free.nv == 7
assert np.allclose(free.body("arm").mass, 2.0)
assert np.allclose(free.body("base").mass, WATER * SIZE.prod())
assert np.allclose(free.body("base").ipos, 0.0)
assert free.body("base").inertia.max() > 30 * fixed.body("base").inertia.max()
PYTHON
