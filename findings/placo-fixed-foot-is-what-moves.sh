#!/usr/bin/env bash
# placo 0.10.2: RobotWrapper.torques_from_acceleration_with_fixed_frame for a body on one leg, a slider without any turn, whose foot
# is the fixed frame: the force of the leg that lifts the body with 2 m/s^2, for several masses; and for a leg of two sliders,
# beside Newton's second law for what is above each of them.
# Expected: m (g + a), with the mass m of the body, as the foot does not move. What comes: m g + F a, with the mass F of the foot: the
# acceleration is given to the foot, as if the body were fixed, and only the weight is passed to the ground. 10 kg on a light foot
# need 98 N whether they stand, jump or drop. With the body as the fixed frame, without acceleration, or with two equal
# masses all is right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet placo==0.10.2 pin==3.8.0 numpy==2.3.5
cd "$folder"
mkdir leg

venv/bin/python - << 'PYTHON'
import numpy as np
import placo

GRAVITY = 9.81


def link(name, mass):
    """One link of a URDF."""
    return (
        f'<link name="{name}"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="{mass}"/>'
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


def load(links, sliders):
    """A robot whose sliders point downwards, one below the other."""
    text = '<robot name="leg">' + "".join(link(*each) for each in links)
    for name, parent, child in sliders:
        text += (
            f'<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/>'
            '<origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 0 -1"/><limit lower="0" upper="2" effort="999" velocity="9"/></joint>'
        )
    with open("leg/robot.urdf", "w", encoding="ascii") as file:
        file.write(text + "</robot>")
    robot = placo.RobotWrapper("leg/robot.urdf", placo.Flags.ignore_collisions)
    robot.update_kinematics()
    return robot


for body, foot in ((10.0, 0.1), (10.0, 2.0), (10.0, 10.0), (1.0, 10.0)):
    robot = load((("body", body), ("foot", foot)), (("leg", "body", "foot"),))
    for acceleration in (0.0, 2.0, -GRAVITY):
        force = robot.torques_from_acceleration_with_fixed_frame_dict(np.array([acceleration]), "foot")["leg"]
        hanging = robot.torques_from_acceleration_with_fixed_frame_dict(np.array([acceleration]), "body")["leg"]
        due = body * (GRAVITY + acceleration)
        print(f"{body} kg on {foot} kg, {acceleration} m/s^2: the leg pushes with {force:.2f} N, due {due:.2f} N")
        assert np.isclose(force, body * GRAVITY + foot * acceleration)
        assert np.isclose(hanging, foot * (acceleration - GRAVITY))
        if acceleration == 0 or body == foot:
            assert np.isclose(force, due)

robot = load((("body", 10.0), ("shank", 3.0), ("foot", 1.0)), (("hip", "body", "shank"), ("ankle", "shank", "foot")))
rates = {"hip": 1.0, "ankle": 2.0}
said = robot.torques_from_acceleration_with_fixed_frame_dict(np.array(list(rates.values())), "foot")
due = {"hip": 10 * (GRAVITY + 3), "ankle": 10 * (GRAVITY + 3) + 3 * (GRAVITY + 2)}
for name, force in due.items():
    print(f"{name} of a leg in two parts: {said[name]:.2f} N, due {force:.2f} N")
    assert said[name] < 0.85 * force
PYTHON
