"""Closest points of convex solids, computed another way than the package does.

Distances are those of the plain program, which shares no line with the package. Curved solids in
penetration have none there: of these, and of every normal, the gap between the solids along
directions is taken from their support functions.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.lab.program.distance import closest_points
from quasistatic_ref.lab.vectors.own.shapes import own_shape
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Shape,
    Sphere,
)

Array = np.ndarray
TURNS = list(Rotation.create_group("O").as_matrix().round())
"""The 24 quarter turns."""
MEETING = 1e-8
"""Curved solids that are nearer [m] are taken for solids that meet."""
HERE = np.eye(3), np.zeros(3)
POINTS = np.random.default_rng(7).normal(size=(30, 3)) * [0.03, 0.04, 0.05]
TABLES: dict[str, dict[str, Any]] = {
    "sphere": {"kind": "sphere", "radius": 0.03},
    "box": {"kind": "box", "size": [0.06, 0.1, 0.16]},
    "capsule": {"kind": "capsule", "radius": 0.03, "length": 0.1},
    "mesh": {"kind": "convex", "vertices": convex_hull(POINTS).vertices.tolist()},
    "cylinder": {"kind": "cylinder", "radius": 0.05, "length": 0.16},
    "cone": {"kind": "cone", "radius": 0.05, "length": 0.16},
    "ellipsoid": {"kind": "ellipsoid", "half_axes": [0.03, 0.05, 0.08]},
    "half-space": {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.01},
}
"""One of each kind, of sizes that have nothing in common, as the vectors write it."""


def solids() -> dict[str, Shape]:
    """The same as shapes of the package."""
    return {name: own_shape(table) for name, table in TABLES.items()}


def pairs() -> list[tuple[str, str]]:
    """Every pair of kinds but two half-spaces."""
    found = itertools.combinations_with_replacement(TABLES, 2)
    return [pair for pair in found if pair != ("half-space", "half-space")]


def poses(count: int, seed: int) -> Iterator[tuple[Array, Array]]:
    """Poses of the second solid in the frame of the first: random, and every kind of degenerate.

    Axes along each other's, centres on axes and planes of symmetry, round distances, tilts of a
    millionth, and the same place.
    """
    random = np.random.default_rng(seed)
    for k in range(count):
        R = Rotation.random(random_state=random).as_matrix()
        t = random.normal(size=3) * 0.07
        if k % 2:
            R = TURNS[random.integers(len(TURNS))]
        if k % 8 == 3:
            R = Rotation.from_rotvec(1e-6 * random.normal(size=3)).as_matrix() @ R
        if k % 4 == 1:
            t = t.round(2)
        if k % 3 == 1:
            t[random.integers(3)] = 0.0
        if k % 3 == 2:
            t[random.permutation(3)[:2]] = 0.0
        if k % 100 == 99:
            t = np.zeros(3)
        yield R, t


def gap(a: Shape, b: Shape, R: Array, t: Array, n: Array) -> Array:
    """Gap between the solids along unit vectors n, shape (N, 3): least of b minus most of a."""
    return n @ t - _most(b, -n @ R) - _most(a, n)


def _most(solid: Shape, n: Array) -> Array:
    """Support function: the largest n . x over the solid, for each n, shape (N, 3)."""
    axial = n[:, 2]
    radial = np.hypot(n[:, 0], n[:, 1])
    match solid:
        case Sphere():
            return np.full(len(n), solid.radius) * np.linalg.norm(n, axis=1)
        case Box():
            return np.abs(n) @ solid.half_extents
        case Capsule():
            return solid.radius * np.linalg.norm(n, axis=1) + solid.half_length * np.abs(axial)
        case Cylinder():
            return solid.radius * radial + solid.half_length * np.abs(axial)
        case Cone():
            return np.maximum(
                solid.half_length * axial, solid.radius * radial - solid.half_length * axial
            )
        case Ellipsoid():
            return np.linalg.norm(n * solid.half_axes, axis=1)
        case ConvexMesh():
            return (n @ solid.vertices.T).max(axis=1)
        case _:
            raise AssertionError(solid)


def signed_distance(names: tuple[str, str], R: Array, t: Array) -> float | None:
    """Signed distance of two solids, the second at pose (R, t) in the frame of the first.

    None of curved solids that meet, or nearly: the plain program has no penetration of these.
    """
    a, b = (TABLES[name] for name in names)
    phi, *_ = closest_points(a, HERE, b, (R, t))
    curved = {"cylinder", "cone", "ellipsoid"} & set(names)
    if curved and not {"sphere", "half-space"} & set(names) and phi <= MEETING:
        return None
    return float(phi)
