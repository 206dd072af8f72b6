#!/usr/bin/env bash
# euclid3 0.01: Quaternion.new_interpolate between two turns about z, and what the result does to the unit vector along x.
# Expected: the first turn at 0, the second at 1, and between them unit quaternions on one of the two arcs.
# What comes: so where the two quaternions have a positive product. Otherwise the first is conjugated instead of negated: from 350
# to 10 degrees it begins at 10, is nothing at all half way, and shrinks the vector to a quarter before; from 100 to -100
# it begins at -100 and stretches the vector by 1.7. The same turns, with the first written as -10 degrees, are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet euclid3==0.01

"$folder/venv/bin/python" - << 'PYTHON'
from math import acos, atan2, cos, degrees, isclose, radians, sin

from euclid3 import Quaternion, Vector3

X, Z = Vector3(1, 0, 0), Vector3(0, 0, 1)


def between(first, second, share):
    """Heading and length of x after the turn, and the quaternion's length."""
    turns = (Quaternion.new_rotate_axis(radians(angle), Z) for angle in (first, second))
    turn = Quaternion.new_interpolate(*turns, share)
    moved = turn * X
    return degrees(atan2(moved.y, moved.x)) % 360, abs(moved), abs(turn)


for first, second in ((170, 200), (-10, 10), (350, 10), (100, -100), (0, 240)):
    product = cos(radians(first - second) / 2)
    angle = acos(abs(product))
    for share in (0, 0.25, 0.5, 0.75, 1):
        heading, length, size = between(first, second, share)
        arc = (second - first + 180) % 360 - 180
        due = (first + share * arc) % 360
        print(
            f"from {first} to {second} degrees at {share}: heading {heading:.2f}, due {due:.2f}; "
            f"x becomes {length:.3f} long, the quaternion {size:.3f}"
        )
        if product > 0:
            assert isclose(cos(radians(heading - due)), 1)
            assert isclose(length, 1)
        else:
            weights = sin((1 - share) * angle) / sin(angle), sin(share * angle) / sin(angle)
            real = sum(w * cos(radians(a) / 2) for w, a in zip(weights, (-first, second)))
            imaginary = sum(w * sin(radians(a) / 2) for w, a in zip(weights, (-first, second)))
            assert isclose(size, (real**2 + imaginary**2) ** 0.5, abs_tol=1e-9)
            assert isclose(length, size**2, abs_tol=1e-9)
    if (first, second) == (350, 10):
        assert between(first, second, 0.5)[1] < 1e-12
        assert isclose(between(first, second, 0)[0], 10)
        assert isclose(between(first, second, 0.25)[1], 0.25, rel_tol=0.01)
    if (first, second) == (100, -100):
        assert between(first, second, 0.5)[1] > 1.7
PYTHON
