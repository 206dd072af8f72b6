#!/usr/bin/env bash
# exudyn 1.13.6: RotationVector2G and RotationVector2GLocal, said to be d omega / d (v dot) of a rotation vector v, in the
# world and in the body, for a body that turns about a fixed axis at a known speed and for one whose vector swings round.
# Expected: from the vector's rate, the angular velocity of the rotation matrix, as from the functions of the same kind for angles.
# What comes: the rotation matrix itself and the identity, whatever the vector. That holds about a fixed axis only; otherwise
# the speed is that of the vector and not of the body: at a quarter turn 1 rad/s for a true 0.9, at 3 rad for 0.665.
# RotXYZ2G, RotXYZ2GLocal, EulerParameters2G and TExpSO3 are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet exudyn==1.13.6 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from exudyn.lieGroupBasics import TExpSO3
from exudyn.rigidBodyUtilities import (
    RotationVector2G,
    RotationVector2GLocal,
    RotationVector2RotationMatrix,
    RotXYZ2G,
    RotXYZ2GLocal,
    RotXYZ2RotationMatrix,
)


def velocities(turn, parameters, rate, step=1e-6):
    """Angular velocity in the world and in the body, from the change of the rotation matrix."""
    slope = (turn(parameters + step * rate) - turn(parameters - step * rate)) / (2 * step)
    matrix = turn(parameters)
    return tuple(np.array([m[2, 1], m[0, 2], m[1, 0]]) for m in (slope @ matrix.T, matrix.T @ slope))


along, across = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
for angle in (0.1, np.pi / 2, 3.0):
    for name, rate in (("fixed axis", along), ("swinging axis", across)):
        vector = angle * along
        world, body = velocities(RotationVector2RotationMatrix, vector, rate)
        from_world, from_body = RotationVector2G(vector) @ rate, RotationVector2GLocal(vector) @ rate
        print(
            f"{angle:.2f} rad, {name}: world {from_world.round(3)}, true {world.round(3)}; "
            f"body {from_body.round(3)}, true {body.round(3)} rad/s"
        )
        assert np.allclose(RotationVector2G(vector), RotationVector2RotationMatrix(vector))
        assert np.array_equal(RotationVector2GLocal(vector), np.eye(3))
        assert np.allclose(TExpSO3(vector) @ rate, body, atol=1e-8)
        if name == "fixed axis":
            assert np.allclose(from_body, body, atol=1e-8)
        else:
            speed = 2 * np.sin(angle / 2) / angle
            assert np.isclose(np.linalg.norm(body), speed)
            assert np.isclose(np.linalg.norm(from_body), 1.0)
            assert np.linalg.norm(from_body - body) > 0.3 * angle
            assert np.linalg.norm(from_world - world) > 0.3 * angle
        angles = np.array([angle, 0.3, -0.4])
        world, body = velocities(RotXYZ2RotationMatrix, angles, rate)
        assert np.allclose(RotXYZ2G(angles) @ rate, world, atol=1e-8)
        assert np.allclose(RotXYZ2GLocal(angles) @ rate, body, atol=1e-8)
PYTHON
