#!/usr/bin/env bash
# coal 3.0.3: the distance from a point to a cube of 2 m, at three places within it, once as a box and once as a closed mesh.
# Expected: the same negative depth, and a normal that leaves the cube. What comes for the mesh: a positive distance to its
# shell, and the opposite normal, though the mesh is closed and coal computes its volume of 8 m^3.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet coal==3.0.3 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import coal
import numpy as np

corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
faces = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]
points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
for corner in corners:
    points.append(corner)
for face in faces:
    triangles.append(coal.Triangle(*face))
mesh = coal.BVHModelOBBRSS()
mesh.beginModel(len(faces), len(corners))
mesh.addSubModel(points, triangles)
mesh.endModel()
print("volume of the mesh:", mesh.computeVolume())
for x in (0.0, 0.5, 0.9):
    place = coal.Transform3s(np.eye(3), np.array([x, 0.1, 0.2]))
    depths, normals = {}, {}
    for name, cube in (("box", coal.Box(2, 2, 2)), ("mesh", mesh)):
        result = coal.DistanceResult()
        request = coal.DistanceRequest()
        depths[name] = coal.distance(cube, coal.Transform3s(), coal.Sphere(0), place, request, result)
        normals[name] = result.normal
        print(f"{name:4} x = {x}: distance {depths[name]:+.3f}, normal {result.normal}")
    assert depths["box"] < 0 < depths["mesh"]
    assert np.isclose(depths["mesh"], -depths["box"])
    assert np.allclose(normals["mesh"], -normals["box"])
PYTHON
