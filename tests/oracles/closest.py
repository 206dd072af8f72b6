"""Closest points of convex solids, computed another way than the package does.

Signed distances are the plain program's, which shares no line with the package, where it has a
closed form. The gap between solids along a direction follows from their support functions: solids
are at least so far apart. It proves the distance of two points of theirs on the direction itself.
"""

import itertools

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import convex_hull
from quasistatic_ref.lab.program.distance import closest_points, core
from quasistatic_ref.lab.vectors.own.shapes import own_shape

TURNS = list(Rotation.create_group("O").as_matrix().round())
"""The 24 quarter turns."""
CURVED = {"cylinder", "cone", "ellipsoid"}
HERE = np.eye(3), np.zeros(3)
POINTS = np.random.default_rng(7).normal(size=(30, 3)) * [0.03, 0.04, 0.05]
TABLES = {
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


def solids(scale=1.0):
    """The same as shapes of the package, all of their sizes times a number."""

    def enlarged(key, size):
        return size if key == "kind" else (scale * np.array(size)).tolist()

    return {
        name: own_shape({key: enlarged(key, size) for key, size in table.items()})
        for name, table in TABLES.items()
    }


def pairs():
    """Every pair of kinds but two half-spaces."""
    found = itertools.combinations_with_replacement(TABLES, 2)
    return [pair for pair in found if pair != ("half-space", "half-space")]


def poses(count, seed):
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


def gap(a, b, R, t, n):
    """Gap between the solids along unit vectors n, shape (N, 3): least of b minus most of a."""
    return n @ t - _most(b, -n @ R) - _most(a, n)


def _most(solid, n):
    """Support function: the largest n . x over the solid, for each unit vector n, shape (N, 3)."""
    found = core(solid, HERE)
    if found is not None:
        points, radius = found
        return (n @ points.T).max(axis=1) + radius
    if solid["kind"] == "ellipsoid":
        return np.linalg.norm(n * solid["half_axes"], axis=1)
    along = n[:, 2] * solid["length"] / 2
    rim = solid["radius"] * np.hypot(n[:, 0], n[:, 1])
    return rim + np.abs(along) if solid["kind"] == "cylinder" else np.maximum(along, rim - along)


def signed_distance(names, R, t):
    """Signed distance of two solids, the second at pose (R, t) in the frame of the first.

    None where the plain program has no closed form: curved solids on one another and on polytopes.
    """
    if set(names) & CURVED and not set(names) & {"sphere", "half-space"}:
        return None
    phi, *_ = closest_points(TABLES[names[0]], HERE, TABLES[names[1]], (R, t))
    return float(phi)
