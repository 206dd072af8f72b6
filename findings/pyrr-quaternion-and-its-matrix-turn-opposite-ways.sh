#!/usr/bin/env bash
# pyrr 0.10.3: a vector turned about x and about a slanted axis, by a quaternion, by the 3 x 3 and 4 x 4 matrices of the same axis
# and angle, and by converting one into the other (matrix33, matrix44, quaternion); beside SciPy.
# Expected: the same vector from all. What comes: the quaternion and the matrices from an axis and an angle turn as SciPy does, and
# every conversion gives the inverse, so that q.matrix33 * v is not q * v, as do the matrices of from_x_rotation, so that
# a turn about x has two signs. There and back again is right, so a round trip does not show it.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pyrr==0.10.3 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from pyrr import Matrix33, Matrix44, Quaternion, Vector3, matrix33, matrix44
from scipy.spatial.transform import Rotation

VECTOR = Vector3([1.0, 2.0, 3.0])
for axis, angle in (([1.0, 0.0, 0.0], 0.7), ([2 / 3, -1 / 3, 2 / 3], 0.1), ([2 / 3, -1 / 3, 2 / 3], 2.0)):
    due = Rotation.from_rotvec(angle * np.array(axis)).apply(VECTOR)
    inverse = Rotation.from_rotvec(-angle * np.array(axis)).apply(VECTOR)
    quaternion = Quaternion.from_axis_rotation(np.array(axis), angle)
    matrix = Matrix33(matrix33.create_from_axis_rotation(np.array(axis), angle))
    direct = {
        "quaternion": quaternion,
        "matrix33": matrix,
        "matrix44": Matrix44(matrix44.create_from_axis_rotation(np.array(axis), angle)),
        "quaternion.matrix33.quaternion": quaternion.matrix33.quaternion,
    }
    converted = {
        "quaternion.matrix33": quaternion.matrix33,
        "quaternion.matrix44": quaternion.matrix44,
        "matrix33.quaternion": matrix.quaternion,
    }
    if axis[0] == 1.0:
        direct["Quaternion.from_x_rotation"] = Quaternion.from_x_rotation(angle)
        converted["Matrix33.from_x_rotation"] = Matrix33.from_x_rotation(angle)
        converted["Matrix44.from_x_rotation"] = Matrix44.from_x_rotation(angle)
    print(f"about {np.round(axis, 3)} by {angle} rad: SciPy {due.round(4)}, the inverse {inverse.round(4)}")
    assert np.linalg.norm(due - inverse) > 0.1
    for turns, reference in ((direct, due), (converted, inverse)):
        for name, turn in turns.items():
            turned = np.array(list(turn * VECTOR), float)
            print(f"  {name} * v: {turned.round(4)}")
            assert np.allclose(turned, reference, atol=1e-6)
PYTHON
