#!/usr/bin/env bash
# gpytoolbox 0.3.8: rotation_matrix_from_vectors ("the output matrix will always be a pure rotation matrix") from a normal to its
# opposite and to one a millionth of a radian beside that, for five normals, used to turn a closed tetrahedron; beside SciPy.
# Expected: half a turn about an axis across the normal, like SciPy's, with determinant 1, and a volume of 1/6 m^3 as before.
# What comes for the opposite: minus the identity, which mirrors, so that the part is inside out, with a volume of -1/6 m^3; a
# millionth beside it all is right. (In the plane minus the identity is half a turn indeed.)
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet gpytoolbox==0.3.8 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from gpytoolbox import rotation_matrix_from_vectors
from scipy.spatial.transform import Rotation

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def volume(corners):
    return np.linalg.det(corners[FACES]).sum() / 6


assert np.isclose(volume(CORNERS), 1 / 6)
for normal in np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [2.0, 3.0, 6.0]]):
    unit = normal / np.linalg.norm(normal)
    aside = np.cross(unit, [0.28, 0.0, 0.96])
    for angle in (0.0, 1e-6):
        target = angle * aside / np.linalg.norm(aside) - unit
        target /= np.linalg.norm(target)
        matrix = rotation_matrix_from_vectors(unit, target)
        other = Rotation.align_vectors(target, unit)[0].as_matrix()
        turned, turned_by_other = volume(CORNERS @ matrix.T), volume(CORNERS @ other.T)
        print(
            f"normal {unit.round(3)}, {angle} rad beside its opposite: determinant {np.linalg.det(matrix):+.3f},",
            f"volume {turned:+.4f} m^3, SciPy {np.linalg.det(other):+.3f} and {turned_by_other:+.4f} m^3",
        )
        assert np.allclose(matrix @ unit, target, atol=1e-9)
        assert np.allclose(other @ unit, target, atol=1e-6)
        assert np.isclose(turned_by_other, 1 / 6)
        assert np.isclose(turned, 1 / 6 if angle else -1 / 6)
        assert angle or np.allclose(matrix, -np.eye(3))
PYTHON
