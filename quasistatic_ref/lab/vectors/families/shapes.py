"""Shapes and poses that the families of `distance` are made from."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

Table = dict[str, Any]

TETRAHEDRON: Final = [[0.2, 0.0, -0.1], [-0.1, 0.18, -0.1], [-0.1, -0.18, -0.1], [0.0, 0.02, 0.2]]
POLYHEDRON: Final = [
    [0.3, 0.1, 0.0],
    [-0.2, 0.3, 0.1],
    [-0.1, -0.3, 0.0],
    [0.05, 0.0, 0.4],
    [0.0, 0.1, -0.2],
    [0.2, -0.2, 0.15],
]

SHAPES: Final[dict[str, Table]] = {
    "sphere": {"kind": "sphere", "radius": 0.2},
    "box": {"kind": "box", "size": [0.3, 0.5, 0.4]},
    "capsule": {"kind": "capsule", "radius": 0.1, "length": 0.5},
    "convex": {"kind": "convex", "vertices": POLYHEDRON},
    "cylinder": {"kind": "cylinder", "radius": 0.15, "length": 0.4},
    "cone": {"kind": "cone", "radius": 0.2, "length": 0.5},
    "ellipsoid": {"kind": "ellipsoid", "half_axes": [0.1, 0.2, 0.3]},
    "halfspace": {"kind": "halfspace", "normal": [0.1, 0.2, 0.97], "offset": 0.1},
}
"""One of each kind, of the size of things that a robot holds."""

UPRIGHT: Final = [0.0, 0.0, 0.0, 1.0]


def at(x: float, y: float, z: float, quaternion: list[float] | None = None) -> Table:
    """A pose at x, y, z [m]."""
    return {"xyz": [x, y, z], "quaternion": UPRIGHT if quaternion is None else quaternion}


def box(x: float, y: float, z: float) -> Table:
    """A box of the full lengths x, y, z [m]."""
    return {"kind": "box", "size": [x, y, z]}


def sphere(radius: float) -> Table:
    """A ball."""
    return {"kind": "sphere", "radius": radius}


def capsule(radius: float, length: float) -> Table:
    """A capsule along z, of the length between the centres of its caps."""
    return {"kind": "capsule", "radius": radius, "length": length}


def cylinder(radius: float, length: float) -> Table:
    """A cylinder along z."""
    return {"kind": "cylinder", "radius": radius, "length": length}


def cone(radius: float, length: float) -> Table:
    """A cone along z, its base below."""
    return {"kind": "cone", "radius": radius, "length": length}


def ellipsoid(x: float, y: float, z: float) -> Table:
    """An ellipsoid of the half axes x, y, z [m]."""
    return {"kind": "ellipsoid", "half_axes": [x, y, z]}


def convex(vertices: list[list[float]]) -> Table:
    """A convex hull."""
    return {"kind": "convex", "vertices": vertices}


def cloud(points: list[list[float]]) -> Table:
    """A cloud."""
    return {"kind": "cloud", "points": points}


FLOOR: Final[Table] = {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.0}


def about_x(angle: float) -> list[float]:
    """Quaternion of a small turn about x: [tan(angle / 2), 0, 0, 1], to first order."""
    return [angle / 2, 0.0, 0.0, 1.0]


ON_SIDE: Final = [1.0, 0.0, 0.0, 1.0]
"""A quarter turn about x: local z becomes -y."""

ALONG_X: Final = [0.0, 1.0, 0.0, 1.0]
"""A quarter turn about y: local z becomes x."""


def mixed_points(shape: Table, rng: np.random.Generator, count: int) -> list[list[float]]:
    """Points inside and outside, the shape's centre, and two on its axis among them."""
    points = np.round(rng.uniform(-0.45, 0.45, (count - 3, 3)), 3) + 0.0
    return [[0.0, 0.0, 0.0], [0.0, 0.0, 0.21], [0.0, 0.0, -0.6], *points.tolist()]
