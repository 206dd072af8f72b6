#!/usr/bin/env bash
# roboticstoolbox-python 1.4.4: a URDF hinge about z through the centre of mass of a plate, whose inertial origin is turned
# about x by angles up to 90 degrees.
# Expected: a mass matrix of iyy sin^2 + izz cos^2 of the angle. What comes: izz at every angle, the rpy of the inertial
# origin is dropped without a word (its xyz is heeded).
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet roboticstoolbox-python==1.4.4 spatialmath-python==1.1.18 numpy==2.4.6
cd "$folder"

venv/bin/python -W ignore - << 'PYTHON'
from pathlib import Path

import numpy as np
import roboticstoolbox

IYY, IZZ, MASS = 0.05, 0.25, 2.0


def hinge(angle, offset):
    Path("plate.urdf").write_text(
        '<robot name="r"><link name="base"/><joint name="hinge" type="revolute"><parent link="base"/><child link="plate"/>'
        '<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="9"/></joint><link name="plate"><inertial>'
        f'<origin xyz="{offset} 0 0" rpy="{angle} 0 0"/><mass value="{MASS}"/>'
        f'<inertia ixx="0.2" iyy="{IYY}" izz="{IZZ}" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>',
        encoding="ascii",
    )
    return roboticstoolbox.Robot.URDF(Path("plate.urdf").resolve()).inertia([0.0]).item()


for angle in (0.0, np.pi / 6, np.pi / 4, np.pi / 2):
    true = IYY * np.sin(angle) ** 2 + IZZ * np.cos(angle) ** 2
    given = hinge(angle, 0.0)
    print(f"turned by {np.degrees(angle):2.0f} degrees: {given:.4f} kg m^2, true {true:.4f}")
    assert np.isclose(given, IZZ)
    assert np.isclose(hinge(angle, 0.3), IZZ + MASS * 0.3**2)
PYTHON
