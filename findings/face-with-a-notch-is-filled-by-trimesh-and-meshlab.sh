#!/usr/bin/env bash
# trimesh 5.2.0, pymeshlab 2025.7.post1 and assimp-py 1.1.0 (as one that is right): an angle bracket with legs of 2 m and
# 0.1 m thick, whose two ends are faces of six corners with a notch, as CAD writes them, as PLY and as OBJ.
# Expected: an area of 8.78 m^2 from each, and 0.7 m from a point between the legs to the bracket.
# What comes: trimesh (both files) and MeshLab (PLY, but not OBJ) cover the notch and fold back, an area of 16 m^2 and a
# distance of 0; the mesh counts as closed and its volume of 0.39 m^3 is right, so checks pass.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet trimesh==5.2.0 pymeshlab==2025.7.post1 assimp-py==1.1.0 \
  numpy==2.4.6 scipy==1.17.1 rtree==1.4.1
cd "$folder"

venv/bin/python - << 'PYTHON'
import assimp_py
import numpy as np
import pymeshlab
import trimesh

OUTLINE = [(1.9, 2), (1.9, 0.1), (0, 0.1), (0, 0), (2, 0), (2, 2)]
AREA, VOLUME, FILLED = 8.78, 0.39, 16.0
n = len(OUTLINE)
corners = [(x, y, z) for z in (0, 1) for x, y in OUTLINE]
faces = [list(range(n))[::-1], list(range(n, 2 * n)), *([i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n))]
ply = f"ply\nformat ascii 1.0\nelement vertex {2 * n}\nproperty double x\nproperty double y\nproperty double z\n"
ply += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
ply += "".join("{} {} {}\n".format(*corner) for corner in corners)
ply += "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
obj = "".join("v {} {} {}\n".format(*corner) for corner in corners)
obj += "".join(f"f {' '.join(str(i + 1) for i in face)}\n" for face in faces)
areas = {}
for suffix, text in (("ply", ply), ("obj", obj)):
    name = f"bracket.{suffix}"
    with open(name, "w", encoding="ascii") as file:
        file.write(text)
    mesh = trimesh.load_mesh(name)
    areas["trimesh", suffix] = mesh.area
    gap = trimesh.proximity.closest_point(mesh, [[1.2, 0.8, 0.0]])[1][0]
    print(f"trimesh {suffix}: closed {mesh.is_watertight}, volume {mesh.volume:.2f}, distance between the legs {gap:.3f}")
    assert mesh.is_watertight
    assert np.isclose(mesh.volume, VOLUME)
    assert gap < 1e-6
    filters = pymeshlab.MeshSet()
    filters.load_new_mesh(name)
    areas["meshlab", suffix] = filters.get_geometric_measures()["surface_area"]
    (part,) = assimp_py.import_file(name, assimp_py.Process_Triangulate).meshes
    a, b, c = np.array(part.vertices).reshape(-1, 3)[np.array(part.indices).reshape(-1, 3)].transpose(1, 0, 2)
    areas["assimp", suffix] = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
for (reader, suffix), area in areas.items():
    print(f"area by {reader} of the {suffix}: {area:.3f} (true {AREA})")
filled = {key for key, area in areas.items() if np.isclose(area, FILLED)}
assert all(np.isclose(area, AREA, atol=1e-4) for key, area in areas.items() if key not in filled)
assert filled == {("trimesh", "ply"), ("trimesh", "obj"), ("meshlab", "ply")}
PYTHON
