#!/usr/bin/env bash
# roboticstoolbox-python 1.4.4: an arm of 2 kg on a hinge about y, once plain and once with flip=True (as which a URDF's axis
# 0 -1 0 is read), a mass on a vertical slide, the same two ways, and two hinges in line.
# Expected: the torque that holds the arm is the derivative of its potential energy by q, so the flipped joint's has the
# other sign; so has the mass matrix's entry between a plain and a flipped hinge.
# What comes: kinematics obey flip, but gravload, rne and inertia are those of the plain joint; the torque pushes down.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet roboticstoolbox-python==1.4.4 spatialmath-python==1.1.18 numpy==2.4.6

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from roboticstoolbox import ET, Link, Robot

MASS, ARM, GRAVITY, STEP = 2.0, 0.5, 9.81, 1e-5
body = {"m": MASS, "r": [ARM, 0, 0], "I": [0.1, 0.2, 0.25, 0, 0, 0]}


def height(motion, q):
    return (motion.A(q) @ [ARM, 0, 0, 1])[2]


for name, make in (("hinge", ET.Ry), ("slide", ET.tz)):
    for flip in (False, True):
        motion = make(flip=flip)
        robot = Robot([Link(motion, name="body", **body)])
        due = MASS * GRAVITY * (height(motion, STEP) - height(motion, -STEP)) / (2 * STEP)
        hold = robot.gravload([0.0])[0]
        inverse = robot.rne(np.zeros(1), np.zeros(1), np.zeros(1))[0]
        print(f"{name}, flip {flip!s:5}: gravload {hold:+.3f}, rne {inverse:+.3f}, derivative of the energy {due:+.3f}")
        assert np.isclose(hold, inverse)
        assert np.isclose(hold, -due if flip else due)

entries = {}
for flip in (False, True):
    first = Link(ET.Rz(), name="first", **body)
    second = Link(ET.tx(1.0) * ET.Rz(flip=flip), parent=first, name="second", **body)
    entries[flip] = Robot([first, second]).inertia([0.0, 0.0])[0, 1]
print(f"between two hinges about z: {entries[False]:+.3f}; the second flipped: {entries[True]:+.3f} (true {-entries[False]:+.3f})")
assert np.isclose(entries[False], 0.25 + MASS * ARM * (1 + ARM))
assert np.isclose(entries[True], entries[False])
PYTHON
