#!/usr/bin/env bash
# roboticstoolbox-python 1.4.4: a URDF of one hinge, whose tip is 1 m away along x, for axes along x, y, z and between them.
# Expected: at angle 0 the tip is at (1, 0, 0) whatever the axis, for the child's frame is then the joint's; later Rodrigues'.
# What comes: so for the coordinate axes. For a slanted axis the tip is elsewhere even at angle 0 (by 1.3 m for axis
# (0, 0.6, 0.8)), because the frame whose z is the axis is never turned back.
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
from scipy.spatial.transform import Rotation

AXES = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0), (0, 0.6, 0.8), (0.6, 0, 0.8), (0.6, 0.8, 0)
for axis in AXES:
    with open("hinge.urdf", "w", encoding="ascii") as file:
        file.write(
            '<robot name="r"><link name="base"/><joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/>'
            f'<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="{" ".join(map(str, axis))}"/>'
            '<limit lower="-2" upper="2" effort="9" velocity="9"/></joint><link name="arm"/>'
            '<joint name="end" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/></joint>'
            '<link name="tip"/></robot>'
        )
    robot = roboticstoolbox.Robot.URDF(Path("hinge.urdf").resolve())
    errors = []
    for angle in (0.0, 1.0):
        tip = robot.fkine([angle], end="tip").t
        true = Rotation.from_rotvec(angle * np.array(axis)).apply([1, 0, 0])
        errors.append(np.linalg.norm(tip - true))
        print(f"axis {axis}, angle {angle}: tip {tip.round(3)}, true {true.round(3)}")
    if np.count_nonzero(axis) == 1:
        assert max(errors) < 1e-12
    else:
        assert min(errors) > 0.5
PYTHON
