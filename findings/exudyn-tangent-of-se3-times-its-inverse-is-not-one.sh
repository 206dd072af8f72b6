#!/usr/bin/env bash
# exudyn 1.13.6: TExpSE3 and TExpSE3Inv of lieGroupBasics, "the tangent operator corresponding to ExpSE3" and its inverse, for twists
# (travel, turn) that turn by 0.1 to 2.5 rad, beside the derivative of ExpSE3 by central differences.
# Expected: each is the inverse of the other, equals the derivative, and maps a twist to itself, since exp(s x) moves along x.
# What comes: their product is off by up to 480. TExpSE3 is right only where travel and turn are at right angles: else it takes
# the square of a skew matrix entry by entry, and a screw along its own axis is turned aside. TExpSE3Inv lacks a factor phi
# before a cotangent, so it is right at one radian (at right angles) and nowhere else. ExpSE3 and both operators of SO(3) are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet exudyn==1.13.6 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from exudyn.lieGroupBasics import ExpSE3, TExpSE3, TExpSE3Inv, TExpSO3, TExpSO3Inv
from scipy.linalg import expm


def hat(twist):
    """The 4 x 4 matrix of a twist (travel, turn)."""
    (u, v, w), (x, y, z) = twist[:3], twist[3:]
    return np.array([[0, -z, y, u], [z, 0, -x, v], [-y, x, 0, w], [0, 0, 0, 0]])


def derivative(twist, step=1e-6):
    """Velocity of exp(twist) in its own frame for a unit speed of each entry of the twist, by central differences."""
    columns = []
    for unit in np.eye(6):
        slope = (expm(hat(twist + step * unit)) - expm(hat(twist - step * unit))) / (2 * step)
        rate = expm(-hat(twist)) @ slope
        columns.append([*rate[:3, 3], rate[2, 1], rate[0, 2], rate[1, 0]])
    return np.array(columns).T


axis = np.array([2.0, -1.0, 2.0]) / 3
for name, travel in (("across", np.array([1.0, 2.0, 0.0])), ("along", 3 * axis), ("slanted", np.array([1.0, 2.0, 3.0]))):
    for angle in (0.1, 0.5, 1.0, 2.5):
        twist = np.array([*travel, *(angle * axis)])
        true = derivative(twist)
        tangent, inverse = TExpSE3(twist), TExpSE3Inv(twist)
        wrong, wrong_inverse = np.abs(tangent - true).max(), np.abs(inverse - np.linalg.inv(true)).max()
        turned = np.linalg.norm(tangent @ twist - twist)
        product = np.abs(tangent @ inverse - np.eye(6)).max()
        print(
            f"travel {name}, turn {angle} rad: off the derivative by {wrong:.1e}, the inverse by {wrong_inverse:.1e}, "
            f"their product off one by {product:.1e}; the twist itself is mapped {turned:.1e} aside"
        )
        assert np.allclose(ExpSE3(twist), expm(hat(twist)))
        assert np.allclose(TExpSO3(twist[3:]) @ TExpSO3Inv(twist[3:]), np.eye(3))
        assert np.allclose(true @ twist, twist, atol=1e-8)
        if name == "across":
            assert wrong < 1e-8
            assert (product > 0.1) == (angle != 1.0)
            assert (wrong_inverse > 0.1) == (angle != 1.0)
        elif angle > 0.4:
            assert wrong > 1e-3
            assert turned > 1e-3
PYTHON
