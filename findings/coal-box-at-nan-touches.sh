#!/usr/bin/env bash
# coal 3.0.3: the distance of two shapes, one of which is placed at x = NaN, as by a configuration that was spoilt before.
# Expected: NaN or an error. What comes: NaN for two spheres, but 0 for two boxes, which reads as contact.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coal==3.0.3 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import coal
import numpy as np


def distance(shape, x):
    placed = coal.Transform3s(np.eye(3), np.array([x, 0.0, 0.0]))
    origin = coal.Transform3s(np.eye(3), np.zeros(3))
    result = coal.DistanceResult()
    return coal.distance(shape, origin, shape, placed, coal.DistanceRequest(), result)


spheres = distance(coal.Sphere(0.1), np.nan)
boxes = distance(coal.Box(0.2, 0.2, 0.2), np.nan)
print("spheres, one metre apart:", distance(coal.Sphere(0.1), 1.0))
print("spheres, x is NaN:", spheres)
print("boxes, one metre apart:", distance(coal.Box(0.2, 0.2, 0.2), 1.0))
print("boxes, x is NaN:", boxes)
assert np.isnan(spheres)
assert boxes == 0.0
PYTHON
