#!/usr/bin/env bash
# mauspaf 0.0.4 (mass properties): open_hollow_box, a thin-walled tube of a rectangular section that is open at both ends, beside
# rectangular_prism, the solid bar of the same size and mass, hollow_box and a sum over the four walls.
# Expected: about its length m (a + b)^2 / 12 for the tube, twice that of the solid bar of a square section.
# What comes: m (a^2 + b^2) / 12, that of the solid bar. With its two ends closed the box has the right moment, more than double
# that of the tube for a quarter more mass.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet mauspaf==0.0.4 unitc==0.0.6 uncertain==0.0.13 PyQt5==5.15.11 sympy==1.14.0 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import math

from mauspaf.masslibrary.shells import hollow_box, open_hollow_box
from mauspaf.masslibrary.solids import rectangular_prism

LENGTH, WALL, DENSITY = 2.0, 0.001, 1000.0


def walls(width, height, mass):
    """Moment of four thin walls about the length, each a line in the section: m l^2 / 12 + m d^2."""
    share = mass / (2 * (width + height))
    return sum(
        2 * share * side * (side**2 / 12 + (other / 2) ** 2) for side, other in ((width, height), (height, width))
    )


for width, height in ((1.0, 1.0), (1.0, 0.5), (0.2, 1.5)):
    tube = open_hollow_box(a=width, b=height, c=LENGTH, t=WALL, rho=DENSITY)
    mass = float(tube["m"])
    solid = rectangular_prism(a=width, b=height, h=LENGTH, m=mass)
    closed = hollow_box(a=width, b=height, c=LENGTH, t=WALL, rho=DENSITY)
    true = walls(width, height, mass)
    ends = 2 * WALL * DENSITY * width * height * (width**2 + height**2) / 12
    print(
        f"tube of {width} by {height} m, {mass:.1f} kg: {float(tube['iy']):.4f} kg m^2 about its length, true {true:.4f}, "
        f"solid bar {float(solid['iz']):.4f}; with two ends of {float(closed['m']) - mass:.1f} kg {float(closed['iy']):.4f}, "
        f"true {true + ends:.4f}"
    )
    assert math.isclose(true, mass * (width + height) ** 2 / 12)
    assert math.isclose(tube["iy"], solid["iz"], rel_tol=1e-9)
    assert math.isclose(closed["iy"], true + ends, rel_tol=1e-9)
    assert math.isclose(true / tube["iy"], (width + height) ** 2 / (width**2 + height**2), rel_tol=1e-9)
PYTHON
