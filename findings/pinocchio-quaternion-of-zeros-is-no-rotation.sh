#!/usr/bin/env bash
# pinocchio 4.1.0: the pose of a free body whose quaternion is (0, 0, 0, 0), as in an array that nobody filled.
# Expected: an error or NaN. What comes: the identity, so that the mistake cannot be seen in any pose; twice a unit
# quaternion comes as a matrix that is no rotation.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin

model = pin.Model()
model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")
data = model.createData()


def rotation(x, y, z, w):
    pin.forwardKinematics(model, data, np.array([0.0, 0.0, 0.0, x, y, z, w]))
    return data.oMi[1].rotation.copy()


zero = rotation(0, 0, 0, 0)
double = rotation(0, 0, np.sqrt(2), np.sqrt(2))
print("of (0, 0, 0, 0):", zero, sep="\n")
print("of twice a quarter turn about z:", double.round(6), sep="\n")
assert np.array_equal(zero, np.eye(3))
assert not np.allclose(double @ double.T, np.eye(3))
PYTHON
