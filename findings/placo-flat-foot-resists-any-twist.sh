#!/usr/bin/env bash
# placo 0.10.2, DynamicsSolver: a planar contact (0.2 m by 0.1 m, mu 0.5) bears 19.62 N, and an actuated joint above it turns
# about the normal. Expected: no solution beyond mu N times the mean distance from the centre, 0.58 N m, and surely none beyond
# mu N times the half diagonal, 1.1 N m. What comes: success, with wrenches that twist by 5 and 10 N m.
# Friction along the plane, and torques that tip, are limited as they should be: 12 N sideways and 1.5 N m have no solution.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet placo==0.10.2 pin==3.8.0 numpy==2.3.5
cd "$folder"

cat > foot.urdf << 'URDF'
<robot name="foot">
  <link name="foot"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="top"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="yaw" type="revolute"><parent link="foot"/><child link="top"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1000" velocity="100"/></joint>
</robot>
URDF

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import placo

MU, LENGTH, WIDTH = 0.5, 0.2, 0.1


def contact_wrench(load):
    """Force and torque of the contact while `load` acts on the top link and nothing moves, or None."""
    robot = placo.RobotWrapper("foot.urdf", placo.Flags.ignore_collisions)
    robot.update_kinematics()
    solver = placo.DynamicsSolver(robot)
    solver.dt = 0.01
    foot = solver.add_frame_task("foot", robot.get_T_world_frame("foot"))
    foot.configure("foot", "hard", 1, 1)
    contact = solver.add_planar_contact(foot)
    contact.mu, contact.length, contact.width, contact.weight_forces = MU, LENGTH, WIDTH, 1e-6
    yaw = solver.add_joints_task()
    yaw.set_joints({"yaw": 0.0})
    yaw.configure("yaw", "soft", 1)
    solver.add_external_wrench_contact("top", "world").w_ext = np.array(load, float)
    result = solver.solve(False)
    return np.array(contact.wrench) if result.success else None


rest = contact_wrench([0, 0, 0, 0, 0, 0])
print("at rest:", np.round(rest, 3))
assert abs(rest[2] - 2 * 9.81) < 1e-3
for torque in (0.3, 5.0, 10.0):
    wrench = contact_wrench([0, 0, 0, 0, 0, torque])
    most = MU * wrench[2] * np.hypot(LENGTH, WIDTH) / 2
    print(f"{torque} N m about the normal: borne with {wrench[5]:.3f} N m; friction can bear less than {most:.2f}")
    assert abs(wrench[5] + torque) < 1e-3
    assert wrench[2] < 19.7
assert contact_wrench([12, 0, 0, 0, 0, 0]) is None
assert contact_wrench([0, 0, 0, 1.5, 0, 0]) is None
print("12 N sideways, 1.5 N m about the long side: no solution")
PYTHON
