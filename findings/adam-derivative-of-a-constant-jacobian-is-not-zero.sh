#!/usr/bin/env bash
# adam-robotics 0.5.0: KinDynComputations.jacobian_dot, documented as the time derivative of the Jacobian, for the base and for the arm
# of a moving robot with one hinge, with body-fixed and mixed velocities; beside the differences of its own jacobian over
# two microseconds.
# Expected: for the base 0, as its Jacobian with respect to its own velocity is the identity always and everywhere.
# What comes: the matrix of a cross product with the velocity of the base. Times the velocity of the robot itself it is right, which
# is what accelerations need; times any other, such as a reference velocity, or alone, as in the derivative of J M^-1 J^T, it is not.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet adam-robotics==0.5.0 numpy==2.3.5 scipy==1.17.1
cd "$folder"

venv/bin/python - << 'PYTHON'
import adam
import numpy as np
from adam.numpy import KinDynComputations
from scipy.spatial.transform import Rotation

STEP = 1e-6
LINK = (
    '<link name="{}"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
with open("robot.urdf", "w", encoding="ascii") as file:
    file.write(
        '<robot name="robot">' + LINK.format("base") + LINK.format("arm") + '<joint name="hinge" type="revolute">'
        '<parent link="base"/><child link="arm"/><origin xyz="0.3 0 0" rpy="0 0 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-2" upper="2" effort="9" velocity="9"/></joint></robot>'
    )
robot = KinDynComputations("robot.urdf", ["hinge"])

# The state, with the base's velocity in the axes of the world.
TURN = Rotation.from_rotvec([0.2, 0.3, 0.4])
PLACE = np.array([0.5, 0.6, 0.7])
ANGLE = 0.3
LINEAR = np.array([0.1, 0.2, 0.3])
ANGULAR = np.array([0.4, 0.5, 0.6])
RATE = np.array([0.7])
OTHER = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


def jacobian(link, time):
    """Jacobian of a link a little later."""
    pose = np.eye(4)
    pose[:3, :3] = (Rotation.from_rotvec(ANGULAR * time) * TURN).as_matrix()
    pose[:3, 3] = PLACE + LINEAR * time
    return np.array(robot.jacobian(link, pose, ANGLE + RATE * time))


pose = np.eye(4)
pose[:3, :3] = TURN.as_matrix()
pose[:3, 3] = PLACE
for representation, base in (
    (adam.Representations.BODY_FIXED_REPRESENTATION, np.concatenate([TURN.inv().apply(LINEAR), TURN.inv().apply(ANGULAR)])),
    (adam.Representations.MIXED_REPRESENTATION, np.concatenate([LINEAR, ANGULAR])),
):
    robot.set_frame_velocity_representation(representation)
    velocity = np.concatenate([base, RATE])
    for link in ("base", "arm"):
        said = np.array(robot.jacobian_dot(link, pose, np.array([ANGLE]), base, RATE))
        differences = (jacobian(link, STEP) - jacobian(link, -STEP)) / (2 * STEP)
        print(
            f"{representation.name}, {link}: largest entry {np.abs(said).max():.3f}, by differences {np.abs(differences).max():.3f}; "
            f"times its own velocity {np.linalg.norm(said @ velocity):.3f}, {np.linalg.norm(differences @ velocity):.3f}; "
            f"times another {np.linalg.norm(said @ OTHER):.3f}, {np.linalg.norm(differences @ OTHER):.3f}"
        )
        assert np.allclose(said @ velocity, differences @ velocity, atol=1e-8)
        assert np.abs(said - differences).max() > 0.5
        if link == "base":
            assert np.allclose(jacobian(link, 0.0), np.eye(6, 7))
            assert np.allclose(differences, 0.0, atol=1e-9)
            assert np.linalg.norm(said @ OTHER) > 0.6
PYTHON
