#!/usr/bin/env bash
# scikit-robot 0.4.7: torque_vector of an arm of 2 kg on a hinge about y, whose base is tilted about y by 0 to 90 degrees, in one
# robot that is asked at each tilt, in a new robot for each, and with root_coords ("If None, uses current coordinates").
# Expected: m g l cos(tilt) from each, and nothing at 90 degrees. What comes: that from a new robot alone; the first question
# fixes the base for good, so a robot that tilts afterwards gets the torques of the upright one, and root_coords does
# nothing. The arm itself does move with the base.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet scikit-robot==0.4.7 numpy==2.4.6 scipy==1.17.1
cd "$folder"

venv/bin/python -W ignore - << 'PYTHON'
import numpy as np
from scipy.spatial.transform import Rotation
from skrobot.coordinates import Coordinates
from skrobot.models.urdf import RobotModelFromURDF

MASS, LENGTH, GRAVITY = 2.0, 0.5, 9.80665
with open("arm.urdf", "w", encoding="ascii") as file:
    file.write(
        '<robot name="r"><link name="base"/><joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/>'
        '<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="9" velocity="9"/></joint>'
        f'<link name="rod"><inertial><origin xyz="{LENGTH} 0 0" rpy="0 0 0"/><mass value="{MASS}"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
    )


def build():
    return RobotModelFromURDF(urdf_file="arm.urdf")


kept = build()
for degrees in (0, 30, 60, 90):
    tilt = np.radians(degrees)
    pose = Coordinates(rot=Rotation.from_rotvec([0.0, tilt, 0.0]).as_matrix())
    new = build()
    new.newcoords(pose)
    kept.newcoords(pose)
    due = -MASS * GRAVITY * LENGTH * np.cos(tilt)
    torques = {
        "new": new.torque_vector()[0],
        "kept": kept.torque_vector()[0],
        "root_coords": build().torque_vector(root_coords=pose)[0],
    }
    print(f"tilted by {degrees} degrees: due {due:.3f} N m;", ", ".join(f"{name} {torque:.3f}" for name, torque in torques.items()))
    assert np.allclose(kept.rod.transform_vector([LENGTH, 0.0, 0.0]), [LENGTH * np.cos(tilt), 0.0, -LENGTH * np.sin(tilt)], atol=1e-6)
    assert np.isclose(torques["new"], due, atol=1e-4)
    assert np.isclose(torques["kept"], -MASS * GRAVITY * LENGTH, atol=1e-4)
    assert np.isclose(torques["root_coords"], -MASS * GRAVITY * LENGTH, atol=1e-4)
PYTHON
