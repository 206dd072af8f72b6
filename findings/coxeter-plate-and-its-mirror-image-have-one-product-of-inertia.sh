#!/usr/bin/env bash
# coxeter 0.11.0: the product of inertia of polygons, said to be the integral of x y, for a triangle, an L and an oblong in each
# of the four quarters of the plane, in both orders of corners; and the principal axis that follows.
# Expected: the sign changes with the quarter: a plate in the second or fourth has a negative one.
# What comes: its magnitude in every quarter, so the axis along which a mirrored plate is longest is that of the plate before the
# mirror: 16.8 degrees for a triangle that leans to 163.2. The two moments are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coxeter==0.11.0 rowan==1.3.2 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from coxeter.shapes import ConvexPolygon, Polygon

PLATES = {
    "triangle": (Polygon, [(0, 0), (2, 0), (0, 1)], 2 / 3, 1 / 6, 1 / 6),
    "oblong": (ConvexPolygon, [(1, 1), (2, 1), (2, 3), (1, 3)], 14 / 3, 26 / 3, 6.0),
    "L": (Polygon, [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 3.0, 3.0, 1.75),
}


def slope(square_x, square_y, product):
    """Direction in which the plate is longest about the origin, in degrees from x."""
    values, vectors = np.linalg.eigh([[square_x, product], [product, square_y]])
    return np.degrees(np.arctan2(*vectors[::-1, -1])) % 180


for name, (kind, corners, square_x, square_y, product) in PLATES.items():
    for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        for order in (1, -1):
            plate = kind(np.array(corners[::order]) * (x, y))
            second_y, second_x, mixed = plate.planar_moments_inertia
            due = x * y * product
            assert np.allclose((second_x, second_y), (square_x, square_y))
            assert np.isclose(mixed, product)
        print(
            f"{name} in the quarter ({x:+}, {y:+}): product {mixed:.4f}, true {due:+.4f}; "
            f"longest along {slope(second_x, second_y, mixed):.1f} degrees, true {slope(second_x, second_y, due):.1f}"
        )
PYTHON
