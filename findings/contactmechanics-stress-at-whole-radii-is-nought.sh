#!/usr/bin/env bash
# ContactMechanics 1.8.3: the stress and displacement of a Hertz contact at distances in radii of the contact, where these are an array
# of whole numbers (np.arange) and where the same numbers have a decimal point.
# Expected: the same. What comes: stress_Cartesian, surface_stress and surface_displacements write their answer into an array
# of the type of the distances, so each value loses its decimals: below the centre the load vanishes, the tension outside the
# rim too, and the ball sinks in by 1 instead of pi / 2. stress, for the same half-space in r and z, does not. No warning.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet ContactMechanics==1.8.3 muGrid==1.6.1 NuMPI==0.18.1 SurfaceTopography==1.27.1 \
    numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from ContactMechanics.ReferenceSolutions import Hertz

POISSON = 0.3
depth = np.arange(1, 4)
centre = np.zeros(3, int)
due = -1 / (1 + depth**2)
whole = Hertz.stress_Cartesian(centre, centre, depth, poisson=POISSON)[2]
decimal = Hertz.stress_Cartesian(centre * 1.0, centre * 1.0, depth * 1.0, poisson=POISSON)[2]
in_depth = Hertz.stress(centre, depth, poisson=POISSON)[2]
print(f"pressure below the centre at {depth} radii: {whole}, with a point {decimal.round(3)}, by r and z {in_depth.round(3)}")
assert np.allclose(decimal, due)
assert np.allclose(in_depth, due)
assert not np.any(whole)

radius = np.arange(4)
tension = np.array([-(1 + 2 * POISSON) / 2, *((1 - 2 * POISSON) / (3 * radius[1:] ** 2))])
whole, decimal = (Hertz.surface_stress(r, poisson=POISSON)[1] for r in (radius, radius * 1.0))
print(f"radial stress of the surface at {radius} radii: {whole}, with a point {decimal.round(3)}")
assert np.allclose(decimal, tension)
assert not np.any(whole)

whole, decimal = (Hertz.surface_displacements(r) for r in (radius, radius * 1.0))
print(f"displacement of the surface at {radius} radii: {whole}, with a point {decimal.round(3)}")
assert np.isclose(decimal[0], -np.pi / 2)
assert np.isclose(decimal[1], -np.pi / 4)
assert np.array_equal(whole, [-1, 0, 0, 0])
PYTHON
