#!/usr/bin/env bash
# coxeter 0.11.0: ConvexSpheropolygon.distance_to_surface, said to be measured from the centroid of the core polygon, for cores
# rounded by 0.5: a square, a right-angled triangle of legs 3 and a trapezium, beside a bisection along each ray.
# Expected: below the centroid (1, 1) of the triangle the rim is at y = -0.5, so the distance is 1.5; towards the long side
# sqrt(1 / 2) + 0.5.
# What comes: 1.569 and 1.109. The straight parts are measured from the centroid of the corners moved outwards, which is another
# point, and the round parts from the core's; only shapes whose two centroids coincide are right, as are all without rounding.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coxeter==0.11.0 rowan==1.3.2 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from coxeter.shapes import ConvexPolygon, ConvexSpheropolygon

ROUNDING = 0.5
CORES = {
    "square": [(1, 1), (-1, 1), (-1, -1), (1, -1)],
    "triangle": [(0, 0), (3, 0), (0, 3)],
    "trapezium": [(0, 0), (4, 0), (3, 1), (1, 1)],
}
ANGLES = np.radians(np.arange(0, 360, 15))


def gap(corners, point):
    """Signed distance of a point from a convex polygon of anticlockwise corners."""
    sides = np.roll(corners, -1, 0) - corners
    offsets = point - corners
    along = np.clip((offsets * sides).sum(1) / (sides**2).sum(1), 0, 1)
    nearest = np.linalg.norm(offsets - along[:, None] * sides, axis=1).min()
    inside = (sides[:, 0] * offsets[:, 1] - sides[:, 1] * offsets[:, 0] >= 0).all()
    return -nearest if inside else nearest


def reach(corners, centre, angle, rounding):
    """Distance from the centre to the rim along one ray, by bisection."""
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        point = centre + middle * np.array([np.cos(angle), np.sin(angle)])
        low, high = (middle, high) if gap(corners, point) < rounding else (low, middle)
    return low


for name, core in CORES.items():
    shape = ConvexSpheropolygon(core, ROUNDING)
    corners = np.array(core, float)
    centre = shape.polygon.centroid[:2]
    distances = shape.distance_to_surface(ANGLES)
    true = np.array([reach(corners, centre, angle, ROUNDING) for angle in ANGLES])
    sharp = ConvexPolygon(core).distance_to_surface(ANGLES)
    error = np.abs(distances - true)
    print(
        f"{name} about {centre.round(3)}: up {distances[6]:.3f}, true {true[6]:.3f}; down {distances[18]:.3f}, true {true[18]:.3f}; "
        f"at 45 degrees {distances[3]:.3f}, true {true[3]:.3f}; {np.sum(error > 0.01)} of 24 rays are wrong, by up to {error.max():.3f}"
    )
    assert np.allclose(sharp, [reach(corners, centre, angle, 0) for angle in ANGLES])
    if name == "square":
        assert error.max() < 1e-9
    else:
        assert np.sum(error > 0.01) > 15
    if name == "triangle":
        assert np.isclose(true[18], 1.5)
        assert np.isclose(true[3], np.sqrt(0.5) + 0.5)
        assert np.isclose(distances[18], 1.569, atol=1e-3)
        assert np.isclose(distances[3], 1.109, atol=1e-3)
PYTHON
