#!/usr/bin/env bash
# scikit-robot 0.4.7: torque_vector of a wrist of two hinges, about z and about y, on whose last link acts a moment of 1 N m, given
# in moment_list, or as a pair of opposite forces in force_list; for angles of the first hinge of 0 to 180 degrees.
# Expected: the same torques, for the documentation speaks of both alike ("applied at target_coords"): that of the second hinge
# is minus the part of the moment along its axis. What comes: so for the forces, which are in world axes; the moment turns along
# with the link, so that a moment about x of the world is none on the second hinge at any angle, and at 180
# degrees a moment about y has the wrong sign. At 0 degrees nothing shows it.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet scikit-robot==0.4.7 numpy==2.4.6
cd "$folder"

venv/bin/python -W ignore - << 'PYTHON'
import numpy as np
from skrobot.coordinates import CascadedCoords
from skrobot.models.urdf import RobotModelFromURDF

LINK = (
    '<link name="{}"><inertial><origin xyz="0 0 0"/><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
HINGE = (
    '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><origin xyz="0 0 0" rpy="0 0 0"/>'
    '<axis xyz="{3}"/><limit lower="-4" upper="4" effort="9" velocity="9"/></joint>'
)
with open("wrist.urdf", "w", encoding="ascii") as file:
    file.write('<robot name="wrist">' + "".join(map(LINK.format, ("base", "fork", "hand"))))
    file.write(HINGE.format("first", "base", "fork", "0 0 1") + HINGE.format("second", "fork", "hand", "0 1 0") + "</robot>")

for degrees in (0, 30, 90, 180):
    angle = np.radians(degrees)
    robot = RobotModelFromURDF(urdf_file="wrist.urdf")
    robot.angle_vector(np.array([angle, 0.0]))
    axes = np.array([[0.0, 0.0, 1.0], [-np.sin(angle), np.cos(angle), 0.0]])
    for moment in np.eye(3):
        arm = np.roll(moment, 1)
        turn = robot.hand.worldrot()
        ends = [CascadedCoords(parent=robot.hand, pos=turn.T @ (sign * arm / 2)) for sign in (1, -1)]
        force = np.cross(moment, arm)
        pair = robot.torque_vector(force_list=[force, -force], target_coords=ends)
        alone = robot.torque_vector(force_list=[np.zeros(3)], moment_list=[moment], target_coords=[robot.hand])
        print(f"at {degrees} degrees, moment {moment}: forces {pair.round(3)}, moment {alone.round(3)}, due {-(axes @ moment).round(3)}")
        assert np.allclose(pair, -axes @ moment, atol=1e-6)
        assert np.allclose(alone, -axes @ (turn @ moment), atol=1e-6)
        if degrees == 0 or moment[2] == 1.0:
            assert np.allclose(alone, pair, atol=1e-6)
        elif degrees == 90:
            assert np.abs(alone - pair).max() > 0.9
        elif degrees == 180 and moment[1] == 1.0:
            assert np.allclose(alone, -pair, atol=1e-6)
            assert np.isclose(abs(pair[1]), 1.0)
PYTHON
