"""Build the bunny's point cloud and URDF from its mesh.

Run ``python build.py`` in this folder; ``--start`` takes another first point of the sampling,
``--mass`` another mass, ``--out`` another folder. The committed files are those of the defaults.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).parent
POINTS = 992  # the paper, III-B
MASS = 0.2  # kg; the paper gives none
START = 0

URDF = """<?xml version="1.0"?>
<!-- Written by build.py: a solid of uniform density inside bunny.obj. -->
<robot name="bunny">
  <link name="bunny">
    <inertial>
      <origin xyz="{c[0]:.9g} {c[1]:.9g} {c[2]:.9g}"/>
      <mass value="{mass:.9g}"/>
      <inertia ixx="{I[0][0]:.9g}" iyy="{I[1][1]:.9g}" izz="{I[2][2]:.9g}"
               ixy="{I[0][1]:.9g}" ixz="{I[0][2]:.9g}" iyz="{I[1][2]:.9g}"/>
    </inertial>
  </link>
</robot>
"""

Array = NDArray[np.float64]


def mesh(path: Path) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (V, 3) [m] and triangles (T, 3) of an OBJ file."""
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = [[float(x) for x in words[1:4]] for words in lines if words[:1] == ["v"]]
    triangles = [[int(w) for w in words[1:4]] for words in lines if words[:1] == ["f"]]
    return np.array(vertices), np.array(triangles) - 1


def farthest_point_sample(points: Array, count: int, start: int) -> NDArray[np.int64]:
    """Indices of `count` points, each the farthest from those before it (least index on a tie)."""
    chosen = [start]
    distance = np.linalg.norm(points - points[start], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen)


def solid_inertia(
    vertices: Array, triangles: NDArray[np.int64], mass: float
) -> tuple[Array, Array]:
    """Centre of mass [m] and inertia about it [kg m^2] of the solid at uniform density.

    Sums the tetrahedra (origin, a, b, c) with their signed volumes V. Over one of them the
    integral of x x' is V/20 (s s' + a a' + b b' + c c'), with s = a + b + c.
    """
    corners = vertices[triangles]  # (T, 3, 3)
    volume = np.linalg.det(corners) / 6
    s = corners.sum(axis=1)
    total = volume.sum()
    centre = volume @ s / 4 / total
    second = np.einsum("t,ti,tj->ij", volume, s, s)
    second += np.einsum("t,tki,tkj->ij", volume, corners, corners)
    covariance = second / 20 / total - np.outer(centre, centre)
    return centre, mass * (np.trace(covariance) * np.eye(3) - covariance)


def main(start: int = START, mass: float = MASS, out: Path = HERE) -> None:
    """Write bunny_992.csv and bunny.urdf."""
    vertices, triangles = mesh(HERE / "bunny.obj")
    cloud = vertices[farthest_point_sample(vertices, POINTS, start)]
    np.savetxt(out / "bunny_992.csv", cloud, "%.6f", ",", header="x,y,z", comments="")
    centre, inertia = solid_inertia(vertices, triangles, mass)
    (out / "bunny.urdf").write_text(URDF.format(c=centre, I=inertia, mass=mass))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--start", type=int, default=START, help="index of the first point")
    parser.add_argument("--mass", type=float, default=MASS, help="[kg]")
    parser.add_argument("--out", type=Path, default=HERE, help="folder")
    given = parser.parse_args()
    main(given.start, given.mass, given.out)
