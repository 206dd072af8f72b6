#!/usr/bin/env bash
# distance3d 0.9.1: a ball 2 m from the middle of a cube of 1 m, which is a Box, a ConvexHullVertices or a MeshGraph, and a ball
# 2 m below a cone or a disk, by four functions that measure the distance and two that tell whether they touch.
# Expected: 2 m less the radius and half the cube, from each. What comes from gjk_nesterov_accelerated_distance: the same for
# the Box; for the others less by another radius, so that a ball of 1 m which is half a metre away is at 0 and touches.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet distance3d==0.9.1 pytransform3d==3.17.0 numba==0.68.1 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import itertools

import numpy as np
from distance3d import colliders, gjk, mesh

VERTICES = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
shapes = {
    "box": (colliders.Box(np.eye(4), np.ones(3)), 0.5),
    "hull": (colliders.ConvexHullVertices(VERTICES), 0.5),
    "mesh": (colliders.MeshGraph(np.eye(4), VERTICES, mesh.make_convex_mesh(VERTICES)), 0.5),
    "cone": (colliders.Cone(np.eye(4), 0.5, 1.0), 0.0),
    "disk": (colliders.Disk(np.zeros(3), 0.5, np.array([0.0, 0.0, 1.0])), 0.0),
}
for (name, (shape, half)), radius in itertools.product(shapes.items(), (0.1, 0.5, 1.0)):
    ball = colliders.Sphere(np.array([0.0, 0.0, -2.0]), radius)
    true = 2 - half - radius
    original, jolt = gjk.gjk_distance_original(shape, ball)[0], gjk.gjk_distance_jolt(shape, ball)[0]
    nesterov = gjk.gjk_nesterov_accelerated_distance(shape, ball)
    touches = gjk.gjk_nesterov_accelerated_intersection(shape, ball)
    print(f"{name:4s}, ball of {radius} m: Nesterov {nesterov:.3f} m, touches: {touches}; original {original:.3f}, ", end="")
    print(f"Jolt {jolt:.3f}, true {true:.3f}")
    assert abs(original - true) < 1e-6 and abs(jolt - true) < 1e-6 and not gjk.gjk_intersection_jolt(shape, ball)
    wrong = 0.0 if name == "box" else radius
    assert abs(nesterov - max(true - wrong, 0)) < 1e-5
    assert bool(touches) == (true - wrong <= 0)
PYTHON
