#!/usr/bin/env bash
# scikit-kinematics 0.10.4 (its functions are the same in 0.12.0, for Python 3.12): quat.quat2seq, the angles of a quaternion in
# the sequences nautical (the default), Helmholtz and Euler (said to be Rz Rx Rz), of turns made from known angles.
# Expected: the angles that went in, or others of the same turn.
# What comes: nautical and Helmholtz are right up to 90 degrees; a heading of 100 degrees is 80, one of 179 is 1, for an arcsine
# cannot tell them apart. The first Euler angle is 180 degrees less it for every tilted turn, so it is right at 90 only.
# rotmat.sequence, which takes the same turns as matrices, has 100 for 100 and 10 for 10.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet scikit-kinematics==0.10.4 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from scipy.spatial.transform import Rotation
from skinematics import quat, rotmat


def apart(one, other):
    """Angle between two turns in degrees."""
    return np.degrees((one.inv() * other).magnitude())


for heading in (30.0, 89.0, 100.0, 120.0, 179.0, -135.0):
    turn = Rotation.from_euler("ZYX", [heading, 20.0, 10.0], degrees=True)
    angles = quat.quat2seq(turn.as_quat(scalar_first=True))[0]
    matrix_angles = np.degrees(rotmat.sequence(turn.as_matrix(), to="nautical"))
    wrong = apart(turn, Rotation.from_euler("ZYX", angles, degrees=True))
    print(f"heading {heading}: {angles.round(3)}, {wrong:.1f} degrees off; from the matrix {matrix_angles.round(3)}")
    assert np.allclose(matrix_angles, [heading, 20, 10])
    folded = np.degrees(np.arcsin(np.sin(np.radians(heading))))
    assert np.allclose(angles, [folded, 20, 10])
    assert np.isclose(wrong, abs(heading - folded), atol=1e-6) or abs(heading) > 90
    assert (wrong > 15) == (abs(heading) > 90)

turn = Rotation.from_euler("YZX", [120.0, 20.0, 10.0], degrees=True)
print("Helmholtz of 120, 20, 10:", quat.quat2seq(turn.as_quat(scalar_first=True), "Helmholtz")[0].round(3))
assert np.allclose(quat.quat2seq(turn.as_quat(scalar_first=True), "Helmholtz"), [60, 20, 10])

for first in (10.0, 45.0, 90.0, 120.0):
    turn = Rotation.from_euler("ZXZ", [first, 20.0, 30.0], degrees=True)
    angles = quat.quat2seq(turn.as_quat(scalar_first=True), "Euler")[0]
    wrong = apart(turn, Rotation.from_euler("ZXZ", angles, degrees=True))
    print(f"Euler angles {first}, 20, 30: {angles.round(3)}, {wrong:.1f} degrees off")
    assert np.allclose(angles, [180 - first, 20, 30])
    assert (wrong > 15) == (first != 90)
PYTHON
