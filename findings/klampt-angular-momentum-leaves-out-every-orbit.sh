#!/usr/bin/env bash
# Klampt 0.10.1.post1: RobotModel.getAngularMomentum of a turntable on which two carts of 1 kg are drawn in from 2 m to 0.5 m, at
# speeds that keep its angular momentum, by its own getMassMatrix; and of a tumbling arm of three links, beside a sum over its links.
# Expected: a constant, the momentum about the centre of mass, which for the turntable is also that about the hinge.
# What comes: the sum of each link's own spin alone, which is momentum about no point at all: a twenty-eighth of it while the carts are
# out, and ten times as much once they are in. The centre of mass, its speed and the kinetic energy are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet klampt==0.10.1.post1 numpy==2.4.6
cd "$folder"

venv/bin/python - << 'PYTHON' 2>&1 | grep --invert-match -e URDFParser -e LoadRobot
import klampt
import numpy as np

MOMENT = 0.1


def load(joints):
    """A robot whose joints are (parent, name, type, axis, centre of mass); each link weighs 1 kg."""
    text = '<robot name="r"><link name="base"/>'
    for parent, name, kind, axis, centre in joints:
        text += (
            f'<link name="{name}"><inertial><origin xyz="{centre}" rpy="0 0 0"/><mass value="1"/><inertia ixx="{MOMENT}" '
            f'iyy="{MOMENT}" izz="{MOMENT}" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="to_{name}" type="{kind}">'
            f'<parent link="{parent}"/><child link="{name}"/><origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="{axis}"/>'
            '<limit lower="-3" upper="3" effort="9" velocity="9"/></joint>'
        )
    with open("robot.urdf", "w", encoding="ascii") as file:
        file.write(text + "</robot>")
    world = klampt.WorldModel()
    assert world.loadElement("robot.urdf") >= 0
    return world


def momentum(robot):
    """Angular momentum about the centre of mass, link by link."""
    total = np.zeros(3)
    for index in range(robot.numLinks()):
        link = robot.link(index)
        mass = link.getMass()
        rotation = np.reshape(link.getTransform()[0], (3, 3)).T
        arm = np.array(link.getWorldPosition(mass.getCom())) - robot.getCom()
        spin = rotation @ np.reshape(mass.getInertia(), (3, 3)) @ rotation.T @ link.getAngularVelocity()
        total += spin + mass.getMass() * np.cross(arm, link.getPointVelocity(mass.getCom()))
    return total


world = load(
    (
        ("base", "table", "revolute", "0 0 1", "0 0 0"),
        ("table", "right", "prismatic", "1 0 0", "0 0 0"),
        ("table", "left", "prismatic", "-1 0 0", "0 0 0"),
    )
)
robot = world.robot(0)
before = robot.numLinks() - 3
said = []
for reach in (2.0, 1.0, 0.5):
    robot.setConfig([0.0] * before + [0.0, reach, reach])
    speed = (2 * 2.0**2 + 3 * MOMENT) / np.array(robot.getMassMatrix())[before, before]
    robot.setVelocity([0.0] * before + [speed, 0.0, 0.0])
    said.append(robot.getAngularMomentum()[2])
    print(f"carts at {reach} m: {speed:.3f} rad/s, momentum {said[-1]:.3f}, true {momentum(robot)[2]:.3f} kg m^2/s")
    assert np.isclose(momentum(robot)[2], 2 * 2.0**2 + 3 * MOMENT, rtol=1e-4)
    assert np.isclose(said[-1], 3 * MOMENT * speed, rtol=1e-3)
assert said[0] < 0.04 * momentum(robot)[2]
assert said[-1] > 10 * said[0]

world = load(
    (
        ("base", "upper", "revolute", "0 0 1", "1 0 0"),
        ("upper", "middle", "revolute", "0 1 0", "0 0 1"),
        ("middle", "lower", "revolute", "1 0 0", "0 1 0"),
    )
)
robot = world.robot(0)
robot.setConfig([0.0] * before + [0.3, 0.4, 0.5])
robot.setVelocity([0.0] * before + [1.0, 2.0, 3.0])
print(f"arm of three links: {np.round(robot.getAngularMomentum(), 3)}, true {momentum(robot).round(3)} kg m^2/s")
assert np.linalg.norm(robot.getAngularMomentum()) < 0.5 * np.linalg.norm(momentum(robot))
PYTHON
