#!/usr/bin/env bash
# coxeter 0.11.0: planar_moments_inertia of a disc and of an ellipse whose centre is off the origin, said to be the integrals of
# y^2 and of x^2, beside a sum over a fine grid and a polygon of 400 corners of the same outline.
# Expected: area d^2 is added to the integral of x^2 for a shift by d along x, as for the polygon.
# What comes: it is added to that of y^2. For a disc of radius 1 moved by 3 along x that of y^2, which no shift along x
# changes, is 29.06, and that of x^2 stays pi / 4. Their sum, the polar moment, is right, and so is a disc moved along the diagonal.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coxeter==0.11.0 rowan==1.3.2 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from coxeter.shapes import Circle, Ellipse, Polygon

ANGLES = np.linspace(0, 2 * np.pi, 400, endpoint=False)
GRID = np.stack(np.meshgrid(*2 * [np.linspace(-3, 3, 3001)]), -1).reshape(-1, 2)
CELL = (6 / 3000) ** 2


def summed(a, b, centre):
    """Integrals of y^2, x^2 and x y over the ellipse, by a sum over cells."""
    inside = (GRID[:, 0] / a) ** 2 + (GRID[:, 1] / b) ** 2 <= 1
    x, y = (GRID[inside] + centre).T
    return np.array([y @ y, x @ x, x @ y]) * CELL


for name, shape, a, b in (("disc", Circle(1.0), 1.0, 1.0), ("ellipse", Ellipse(1.0, 2.0), 1.0, 2.0)):
    for centre in ((0.0, 0.0), (3.0, 0.0), (0.0, 2.0), (3.0, 2.0), (2.0, 2.0)):
        shape.centroid = (*centre, 0.0)
        moments = np.array(shape.planar_moments_inertia, float)
        true = summed(a, b, centre)
        corners = np.stack([a * np.cos(ANGLES), b * np.sin(ANGLES)], 1) + centre
        polygon = np.array(Polygon(corners).planar_moments_inertia)
        print(f"{name} at {centre}: {moments.round(3)}, true {true.round(3)}, polygon {polygon.round(3)}")
        area = np.pi * a * b
        due = area * np.array([b**2 / 4 + centre[1] ** 2, a**2 / 4 + centre[0] ** 2, centre[0] * centre[1]])
        assert np.allclose(true, due, rtol=2e-3, atol=1e-2)
        assert np.allclose(polygon, due, rtol=2e-3, atol=1e-2)
        shifted = area * np.array([b**2 / 4 + centre[0] ** 2, a**2 / 4 + centre[1] ** 2, centre[0] * centre[1]])
        assert np.allclose(moments, shifted)
        assert np.isclose(moments[:2].sum(), due[:2].sum())
PYTHON
