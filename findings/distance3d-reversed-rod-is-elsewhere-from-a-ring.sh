#!/usr/bin/env bash
# distance3d 0.9.1: line_segment_to_circle for a ring of radius 1 m and a rod from x = 0.5 m to x = 1.1, 1.4 or 3 m, at heights
# of 0 to 0.5 m above the ring's plane, with its inner end as the start and as the end.
# Expected: the same both ways, the height where the rod passes over the rim. What comes: so with the inner end as the start;
# the other way the distance of that inner end, 0.5 m even where the rod goes through the rim.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet distance3d==0.9.1 pytransform3d==3.17.0 numba==0.68.1 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from distance3d.distance import line_segment_to_circle

RING = (np.zeros(3), 1.0, np.array([0.0, 0.0, 1.0]))
for outer in (1.1, 1.4, 3.0):
    for true in (0.0, 0.1, 0.3, 0.5):
        inside, outside = np.array([0.5, 0.0, true]), np.array([outer, 0.0, true])
        outwards, *points = line_segment_to_circle(inside, outside, *RING)
        inwards, *others = line_segment_to_circle(outside, inside, *RING)
        print(f"to x = {outer} m at height {true} m: outwards {outwards:.3f} m, inwards {inwards:.3f} m")
        assert abs(outwards - true) < 1e-9
        assert abs(inwards - np.hypot(0.5, true)) < 1e-9
        assert np.allclose(others[0], inside)
PYTHON
