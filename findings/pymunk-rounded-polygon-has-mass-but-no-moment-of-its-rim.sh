#!/usr/bin/env bash
# pymunk 7.3.1: a square with rounded corners (Poly with a radius) of density 1, as wide as a disc of radius 0.5 m, for radii
# from 0 to 0.49 m, where it is all but that disc.
# Expected: mass and moment of inertia of the rounded area, in the end those of the disc.
# What comes: the mass is right, but the moment is that of the sharp square within, as if its mass were all of it: at last
# a two-thousandth of the disc's, so that a touch off centre spins it as many times too fast.
# Nor does moment_for_poly heed the radius that it takes.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pymunk==7.3.1

"$folder/venv/bin/python" - << 'PYTHON'
import math

import pymunk

HALF = 0.5


def true(side, r):
    """Area, and moment about the centre, of a square with all that lies within r of it."""
    quarter = math.pi * r**2 / 4
    centre = 4 * r / (3 * math.pi)
    corner = r**4 * math.pi / 8 + 2 * quarter * ((side / 2 + centre) ** 2 - centre**2)
    edge = side * r * ((side**2 + r**2) / 12 + (side / 2 + r / 2) ** 2)
    return side**2 + 4 * side * r + 4 * quarter, side**4 / 6 + 4 * edge + 4 * corner


def added(shape):
    shape.density = 1.0
    space = pymunk.Space()
    space.add(shape.body, shape)
    return shape.body.mass, shape.body.moment


disc = added(pymunk.Circle(pymunk.Body(), HALF))
for radius in (0.0, 0.1, 0.25, 0.49):
    side = 2 * (HALF - radius)
    corners = [(x * side / 2, y * side / 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mass, moment = added(pymunk.Poly(pymunk.Body(), corners, radius=radius))
    area, due = true(side, radius)
    print(f"radius {radius:4}: mass {mass:.5f} (true {area:.5f}), moment {moment:.6f} (true {due:.6f}; disc {disc[1]:.6f})")
    assert math.isclose(mass, area, rel_tol=1e-6)
    assert math.isclose(moment, mass * side**2 / 6, rel_tol=1e-6)
    assert radius > 0 or math.isclose(moment, due, rel_tol=1e-6)
    assert pymunk.moment_for_poly(1.0, corners, (0, 0), radius) == pymunk.moment_for_poly(1.0, corners)
assert math.isclose(due, disc[1], rel_tol=0.03)
assert moment < due / 1000
PYTHON
