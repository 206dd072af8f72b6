#!/usr/bin/env bash
# tribology 0.5.16: the approach of two bodies in Hertz contact from dhertz, beside the half axes from ahertz, for one load, one pair of
# bodies and the effective modulus that eeff gives for them: steel on steel, 100 N, a ball and then ever longer barrels on a flat.
# Expected: for a ball d = a^2 / R, as in any textbook (Johnson, Contact Mechanics, 4.2); for a barrel the elliptic integrals.
# What comes: the half axes are right to two per cent, and d is 0.63 = 2^(-2/3) of what belongs to them, as dhertz takes for half of
# itself the modulus that eeff doubles. With the modulus halved by hand the ball is right, but not a barrel: one of 10 x 200 mm still
# gets a sixth of its approach, as dhertz squares the square of the eccentricity.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet numpy==2.4.6 scipy==1.17.1 numexpr==2.14.2 matplotlib==3.10.7 \
    opencv-python-headless==4.13.0.92
# It asks for a numpy and an OpenCV of 2019.
"$folder/venv/bin/python" -m pip install --quiet --no-deps tribology==0.5.16

"$folder/venv/bin/python" - << 'PYTHON'
from math import inf, pi, sqrt

import tribology
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

YOUNG = 210e9
POISSON = 0.3
FORCE = 100.0
RADIUS = 0.01
# 1 / E* is the sum of (1 - nu^2) / E over both bodies.
CONTACT_MODULUS = YOUNG / (2 * (1 - POISSON**2))


def hertz(short, long):
    """Half axes along the short and the long radius, and the approach, in metres."""
    if short == long:
        axis = (3 * FORCE * short / (4 * CONTACT_MODULUS)) ** (1 / 3)
        return axis, axis, axis**2 / short

    def residual(m):
        return (ellipe(m) / (1 - m) - ellipk(m)) / (ellipk(m) - ellipe(m)) - long / short

    m = brentq(residual, 1e-9, 1 - 1e-12)
    major = (3 * FORCE * (ellipk(m) - ellipe(m)) * long / (pi * CONTACT_MODULUS * m)) ** (1 / 3)
    minor = major * sqrt(1 - m)
    return minor, major, 3 * FORCE * ellipk(m) / (2 * pi * major * CONTACT_MODULUS)


modulus = tribology.eeff(YOUNG, POISSON, YOUNG, POISSON)
assert abs(modulus / CONTACT_MODULUS - 2) < 1e-9
for long in (0.01, 0.02, 0.05, 0.2):
    minor, major, due = hertz(RADIUS, long)
    area = tribology.ahertz(*tribology.reff(RADIUS, long, inf, inf), modulus, FORCE)
    depth = tribology.dhertz(modulus, RADIUS, long, inf, inf, FORCE)
    halved = tribology.dhertz(modulus / 2, RADIUS, long, inf, inf, FORCE)
    print(
        f"radii {1e3 * RADIUS:.0f} and {1e3 * long:.0f} mm: half axes {1e6 * area[0]:.1f} and {1e6 * area[1]:.1f} um, true "
        f"{1e6 * minor:.1f} and {1e6 * major:.1f} um; approach {1e6 * depth:.3f} um, {1e6 * halved:.3f} um with E / 2, "
        f"true {1e6 * due:.3f} um"
    )
    assert abs(area[0] / minor - 1) < 0.02
    assert abs(area[1] / major - 1) < 0.02
    if long == RADIUS:
        assert abs(depth / due - 2 ** (-2 / 3)) < 1e-6
        assert abs(halved / due - 1) < 1e-6
    else:
        assert depth < 0.51 * due
        assert halved < 0.8 * due
    if long == 0.2:
        assert halved < 0.18 * due
PYTHON
