#!/usr/bin/env bash
# coal 3.0.3: the distance of two capsules, 0.1 m long, 0.1 m apart, whose axes are turned by a hundred-thousandth of a radian.
# Expected: the least distance, as between the ends that lean to each other. What comes: half a micrometre more, the distance
# of the middles, as if the axes were parallel; exactly parallel ones and those turned by a thousandth are right to 1e-16 m.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coal==3.0.3 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import coal
import numpy as np

RADIUS, HALF = 0.03, 0.05


def turned(angle):
    """The rotation by an angle about (-0.874, -0.486, 0)."""
    x, y = -0.8740, -0.4859
    K = np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def distance_of_ends(R, t):
    """The distance between capsules along the ends of their axes: at least the least distance."""
    ends = np.array([[0, 0, -HALF], [0, 0, HALF]])
    others = ends @ R.T + t
    least = np.inf
    for end in others:  # to the other axis, which is that of z
        foot = np.array([0, 0, np.clip(end[2], -HALF, HALF)])
        least = min(least, np.linalg.norm(end - foot))
    axis = R[:, 2]
    for end in ends:
        along = np.clip((end - t) @ axis, -HALF, HALF)
        least = min(least, np.linalg.norm(end - t - along * axis))
    return least - 2 * RADIUS


request = coal.DistanceRequest()
request.enable_signed_distance = True
capsule = coal.Capsule(RADIUS, 2 * HALF)
t = np.array([0.1, 0.00095, 0.00109])
excess = {}
for angle in (0.0, 1e-7, 1e-6, 1e-5, 1e-3):
    R = turned(angle)
    there = coal.Transform3s(R, t)
    by_coal = coal.distance(capsule, coal.Transform3s(), capsule, there, request, coal.DistanceResult())
    excess[angle] = by_coal - distance_of_ends(R, t)
    print(f"turned by {angle:g} rad: coal's distance is larger than that of two of their points by {excess[angle]:.2g} m")
assert abs(excess[0.0]) < 1e-15
assert excess[1e-6] > 1e-8
assert excess[1e-5] > 1e-7
assert abs(excess[1e-3]) < 1e-15
PYTHON
