#!/usr/bin/env bash
# coal 3.0.3: an OBJ file of two cubes, 1 m apart, of which each has a material of its own ("usemtl").
# Expected: both cubes, as trimesh reads them. What comes: all 16 vertices, but the triangles of the second cube are those
# of the first once more: balls above the two cubes have gaps of 0.3 m and 0.88 m instead of 0.3 m twice.
# Nothing looks odd: the box around the mesh holds both cubes, and the volume is that of both. Without materials it is read rightly.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coal==3.0.3 trimesh==4.12.2 numpy==2.4.6

cd "$folder"
"$folder/venv/bin/python" - << 'PYTHON'
from pathlib import Path

import coal
import numpy as np
import trimesh

CORNERS = 0.1 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
BOUNDS = [[-0.1, -0.1, -0.1], [1.1, 0.1, 0.1]]
FACES = "1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"


def text(*parts):
    """An OBJ file with a cube about (0, 0, 0) and one about (1, 0, 0); before the faces of each, its line of `parts`."""
    lines = []
    for i, part in enumerate(parts):
        lines += [f"v {x} {y} {z}" for x, y, z in CORNERS + [i, 0, 0]] + [part]
        lines += ["f " + " ".join(str(int(k) + 8 * i) for k in face.split()) for face in FACES]
    return "\n".join(lines) + "\n"


def gap(mesh, x):
    """Of a ball of radius 0.1 about (x, 0, 0.5)."""
    origin = coal.Transform3s(np.eye(3), np.zeros(3))
    place = coal.Transform3s(np.eye(3), np.array([x, 0.0, 0.5]))
    return coal.distance(mesh, origin, coal.Sphere(0.1), place, coal.DistanceRequest(), coal.DistanceResult())


def read(name):
    mesh = coal.MeshLoader(coal.BV_OBBRSS).load(name, np.ones(3))
    mesh.computeLocalAABB()
    assert np.allclose([mesh.aabb_local.min_, mesh.aabb_local.max_], BOUNDS)
    assert np.isclose(mesh.computeVolume(), 0.016)
    used = {mesh.tri_indices(i)[k] for i in range(mesh.num_tris) for k in range(3)}
    gaps = gap(mesh, 0.0), gap(mesh, 1.0)
    print(f"{name}: {mesh.num_vertices} vertices, {mesh.num_tris} triangles with {len(used)} of them, gaps", *np.round(gaps, 6))
    return len(used), gaps


Path("plain.obj").write_text(text("# a cube", "# another"))
Path("coloured.obj").write_text(text("usemtl red", "usemtl blue"))
for name in "plain.obj", "coloured.obj":
    scene = trimesh.load_scene(name)
    assert np.allclose(scene.bounds, BOUNDS)
    assert np.isclose(scene.to_mesh().center_mass[0], 0.5)
used, gaps = read("plain.obj")
assert used == 16
assert np.allclose(gaps, 0.3)
used, gaps = read("coloured.obj")
assert used == 8
nearest = np.hypot(0.9, 0.4) - 0.1  # of the edge of the first cube
assert np.allclose(gaps, [0.3, nearest])
PYTHON
