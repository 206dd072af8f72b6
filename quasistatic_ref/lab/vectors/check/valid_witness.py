"""Whether two points and a normal prove a signed distance, for answers that are not unique.

If alpha lies in its body and is its farthest point along n, beta in its own and the farthest
against n, then the gap along n is the signed distance, apart and in penetration. How far a point
is outside of a shape and how far a shape reaches are the plain program's, in float64.
"""

from typing import TypeAlias

import numpy as np

from quasistatic_ref.lab.program.distance import on_halfspace, points_on
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.vectors.tables import ORIGIN
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array

Sides: TypeAlias = dict[str, tuple[Json, tuple[Array, Array]]]
"""Shape, and R and t of its pose, of ``alpha`` and of ``beta``."""
POINT = {"kind": "sphere", "radius": 0.0}
TILTED = 1e-9
"""Sine of an angle: that between a half-space's normal and a direction of float64 is 1e-16. To
fewer digits the tolerance of n is larger, and takes its place."""


def witness_problem(
    sides: Sides, phi: float, alpha: Array, beta: Array, n: Array, tolerance: float
) -> str | None:
    """What is wrong with a witness; None if it proves phi to within the tolerance.

    Parameters
    ----------
    sides : Sides
        Two solids (a point of a cloud as a sphere of radius zero).
    phi : float
        Signed distance [m].
    alpha, beta, n : ndarray, shape (3,)
        World frame.
    tolerance : float
        [m], and [-] for n.
    """
    if abs(np.linalg.norm(n) - 1) > tolerance:
        return "n is not of length one"
    if np.abs(beta - alpha - phi * n).max() > tolerance:
        return "beta - alpha is not phi n"
    for name, point, direction in (("alpha", alpha, n), ("beta", beta, -n)):
        shape, (R, t) = sides[name]
        heights, normals = points_on(shape, ((point - t) @ R)[None])
        if heights[0] > tolerance:
            return f"{name} is outside its shape"
        if shape["kind"] == "halfspace":
            normal = R @ normals[0]
            sine = np.linalg.norm(np.cross(direction, normal))
            ends = sine <= max(TILTED, tolerance) and direction @ normal > 0
            gap = heights[0] if ends else -np.inf
        else:
            beyond = {"normal": -direction, "offset": -direction @ point}
            gap, *_ = on_halfspace(beyond, frame(ORIGIN), shape, (R, t))
        if gap < -tolerance:
            return f"{name} is not where its shape ends along n"
    return None


def each_solid(sides: Sides) -> list[Sides]:
    """Both sides of a pair; for a cloud, one pair of sides for each of its points."""
    for name, (shape, (R, t)) in sides.items():
        if shape["kind"] == "cloud":
            points = np.array(shape["points"]) @ R.T + t
            return [{**sides, name: (POINT, (R, point))} for point in points]
    return [sides]
