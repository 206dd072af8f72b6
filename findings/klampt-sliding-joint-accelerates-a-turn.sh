#!/usr/bin/env bash
# Klampt 0.10.1.post1: RobotModelLink.getAngularAcceleration of a cart that slides outwards, across or along the axis on a turntable of
# constant speed, with no acceleration of either joint; beside the change of its own getAngularVelocity over 20 microseconds.
# Expected: zero, as a cart turns with its table wherever it is. What comes: the angular velocity of the table crossed with the
# speed of sliding, a length per second squared, so that it also changes with the unit of length; twice the speed, twice as
# much. Slides along the axis do not show it, and arms of hinges alone are right, as is getPointAcceleration.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet klampt==0.10.1.post1 numpy==2.4.6
cd "$folder"

venv/bin/python - << 'PYTHON' 2>&1 | grep --invert-match -e URDFParser -e LoadRobot
import klampt
import numpy as np

TURN = 2.0
STEP = 1e-5


def accelerations(kind, axis, speed):
    """Angular acceleration of the last of two links about z and about or along axis: what Klampt says, and by differences."""
    text = '<robot name="r"><link name="base"/>'
    for parent, name, joint, line in (("base", "table", "revolute", "0 0 1"), ("table", "cart", kind, axis)):
        text += (
            f'<link name="{name}"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
            f'ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="to_{name}" type="{joint}"><parent link="{parent}"/>'
            f'<child link="{name}"/><origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="{line}"/>'
            '<limit lower="-3" upper="3" effort="9" velocity="9"/></joint>'
        )
    with open("table.urdf", "w", encoding="ascii") as file:
        file.write(text + "</robot>")
    world = klampt.WorldModel()
    assert world.loadElement("table.urdf") >= 0
    robot = world.robot(0)
    cart = robot.link("cart")
    before = [0.0] * (robot.numLinks() - 2)

    def velocities(time):
        robot.setConfig([*before, 0.3 + TURN * time, 0.5 + speed * time])
        robot.setVelocity([*before, TURN, speed])
        return np.array(cart.getAngularVelocity()), np.array(cart.getPointVelocity([0.0, 0.0, 0.0]))

    differences = [(later - sooner) / (2 * STEP) for later, sooner in zip(velocities(STEP), velocities(-STEP), strict=True)]
    velocities(0.0)
    still = [0.0] * robot.numLinks()
    assert np.allclose(cart.getPointAcceleration([0.0, 0.0, 0.0], still), differences[1], atol=1e-5)
    return np.array(cart.getAngularAcceleration(still)), differences[0]


AXES = {"1 0 0": [np.cos(0.3), np.sin(0.3), 0.0], "0 1 0": [-np.sin(0.3), np.cos(0.3), 0.0], "0 0 1": [0.0, 0.0, 1.0]}
for kind in ("prismatic", "revolute"):
    for axis, direction in AXES.items():
        for speed in (1.0, 2.0):
            said, differences = accelerations(kind, axis, speed)
            crossed = np.cross([0.0, 0.0, TURN], speed * np.array(direction))
            print(f"{kind} along {axis} at {speed}: {said.round(4)} rad/s^2, by differences {differences.round(4) + 0.0}")
            assert np.allclose(said, crossed, atol=1e-6)
            assert np.allclose(differences, 0.0 if kind == "prismatic" else crossed, atol=1e-4)
PYTHON
