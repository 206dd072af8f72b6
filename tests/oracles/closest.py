"""Closest points of convex solids, computed another way than the package does.

Polytopes: the hull of all differences of corners (qhull), whose facets give the depth, and a
quadratic program (DAQP) for the distance. Solids of revolution on a sphere: the cross-section, a
polygon. An ellipsoid on a sphere: Lagrange's condition in 40 digits. Curved pairs: the
second-order cone program of the distance (Clarabel); in penetration, where there is no closed
form, the gap over many directions. Half-spaces: the support functions, as values.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator

import cvxpy as cp
import daqp
import mpmath
import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Shape,
    Sphere,
)

Array = np.ndarray
TURNS = list(Rotation.create_group("O").as_matrix().round())
"""The 24 quarter turns."""
MEETING = 1e-8
"""A distance [m] that the cone program cannot tell from none."""


def solids() -> dict[str, Shape]:
    """One of each kind, of sizes that have nothing in common."""
    points = np.random.default_rng(7).normal(size=(30, 3)) * [0.03, 0.04, 0.05]
    return {
        "sphere": Sphere(0.03),
        "box": Box(np.array([0.03, 0.05, 0.08])),
        "capsule": Capsule(0.03, 0.05),
        "mesh": convex_hull(points),
        "cylinder": Cylinder(0.05, 0.08),
        "cone": Cone(0.05, 0.08),
        "ellipsoid": Ellipsoid(np.array([0.03, 0.05, 0.08])),
        "half-space": HalfSpace(np.array([0.0, 0.0, 1.0]), 0.01),
    }


def pairs() -> list[tuple[str, str]]:
    """Every pair of kinds but two half-spaces."""
    kinds = list(solids())
    found = itertools.combinations_with_replacement(kinds, 2)
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


def signed_distance(a: Shape, b: Shape, R: Array, t: Array) -> float | None:
    """Signed distance of b, at pose (R, t) in a's frame, to a; None where nothing is exact."""
    if isinstance(a, HalfSpace) or isinstance(b, HalfSpace):
        if isinstance(a, HalfSpace):
            return float(a.normal @ t - a.offset - _most(b, -(a.normal @ R)[None])[0])
        n = R @ b.normal
        return float(-n @ t - b.offset - _most(a, -n[None])[0])
    if isinstance(a, Sphere):
        return _on_sphere(b, -R.T @ t, a.radius)
    if isinstance(b, Sphere):
        return _on_sphere(a, t, b.radius)
    P, p = _corners(a)
    Q, q = _corners(b)
    if isinstance(a, Capsule) and isinstance(b, Capsule):
        assert P is not None
        assert Q is not None
        return _segments(P, Q @ R.T + t) - p - q
    if P is not None and Q is not None:
        return _of_differences((Q @ R.T + t)[:, None] - P) - p - q
    distance = _by_cones(a, b, R, t)
    return distance if distance > MEETING else None


def _corners(solid: Shape) -> tuple[Array | None, float]:
    """Corners of the core, and the radius of the ball about every point of it."""
    match solid:
        case Box():
            return np.array(list(itertools.product([-1, 1], repeat=3))) * solid.half_extents, 0.0
        case ConvexMesh():
            return solid.vertices, 0.0
        case Capsule():
            return np.array([[0, 0, -1], [0, 0, 1]]) * solid.half_length, solid.radius
        case _:
            return None, 0.0


def _on_sphere(solid: Shape, centre: Array, radius: float) -> float:
    match solid:
        case Sphere():
            return float(np.linalg.norm(centre)) - solid.radius - radius
        case Capsule():
            beyond = max(abs(centre[2]) - solid.half_length, 0.0)
            return float(np.linalg.norm([*centre[:2], beyond])) - solid.radius - radius
        case Box() | ConvexMesh():
            corners, _ = _corners(solid)
            assert corners is not None
            return _of_differences((centre - corners)[:, None]) - radius
        case Cylinder():
            r = solid.radius
            h = solid.half_length
            return _polygon([(r, -h), (r, h), (-r, h), (-r, -h)], centre) - radius
        case Cone():
            r = solid.radius
            h = solid.half_length
            return _polygon([(r, -h), (0, h), (-r, -h)], centre) - radius
        case Ellipsoid():
            return _ellipsoid(solid.half_axes, centre) - radius
        case _:
            raise AssertionError(solid)


def _polygon(corners: list[tuple[float, float]], point: Array) -> float:
    """Signed distance to the cross-section of a solid of revolution, counter-clockwise."""
    p = np.array([np.hypot(point[0], point[1]), point[2]])
    nearest = np.inf
    inside = True
    for u, v in zip(corners, corners[1:] + corners[:1], strict=True):
        u, way = np.array(u), np.subtract(v, u)
        s = np.clip((p - u) @ way / (way @ way), 0, 1)
        nearest = min(nearest, float(np.linalg.norm(p - u - s * way)))
        inside &= bool(way[0] * (p - u)[1] - way[1] * (p - u)[0] >= 0)
    return -nearest if inside else nearest


def _ellipsoid(half_axes: Array, point: Array) -> float:
    """Largest root t of sum (e_i p_i / (t + e_i^2))^2 = 1 by bisection in 40 digits."""
    with mpmath.workdps(40):
        e = [mpmath.mpf(float(x)) for x in half_axes]
        p = [abs(mpmath.mpf(float(x))) for x in point]
        least = min(range(3), key=lambda i: e[i])
        low = -(e[least] ** 2) + mpmath.mpf(10) ** -60
        p[least] = max(p[least], mpmath.mpf(10) ** -30)
        high = max(e) * mpmath.sqrt(sum(x * x for x in p)) + mpmath.mpf(1)

        def excess(t: mpmath.mpf) -> mpmath.mpf:
            return sum((e[i] * p[i] / (t + e[i] ** 2)) ** 2 for i in range(3)) - 1

        for _ in range(220):
            middle = (low + high) / 2
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        x = [e[i] ** 2 * p[i] / (high + e[i] ** 2) for i in range(3)]
        distance = mpmath.sqrt(sum((p[i] - x[i]) ** 2 for i in range(3)))
        return float(distance if high > 0 else -distance)


def _segments(P: Array, Q: Array) -> float:
    """Distance of two segments: its square is convex along the first; by thirds, in 80 bits."""
    p = P.astype(np.longdouble)
    q = Q.astype(np.longdouble)
    way = q[1] - q[0]

    def square(s: np.longdouble) -> np.longdouble:
        arm = p[0] + s * (p[1] - p[0]) - q[0]
        off = arm - np.clip(arm @ way / (way @ way), 0, 1) * way
        return off @ off

    low = np.longdouble(0)
    high = np.longdouble(1)
    for _ in range(110):
        u = low + (high - low) / 3
        v = high - (high - low) / 3
        low, high = (low, v) if square(u) <= square(v) else (u, high)
    return float(np.sqrt(min(square(low), square(high), square((low + high) / 2))))


def _of_differences(points: Array) -> float:
    """Signed distance of the origin to the hull of the points (sign: inside is negative)."""
    points = points.reshape(-1, 3)
    rank = np.linalg.matrix_rank(points - points[0], tol=1e-9)
    if rank == 3:
        hull = ConvexHull(points)
        level = hull.equations[:, 3].max()
        if level <= 0:
            return float(level)
        points = points[hull.vertices]
    # The point of the hull of least length: min |P' w|^2 over weights w. Its dual form, the
    # farthest plane between, has three unknowns: max s with p_i . n >= s, as min |x|^2 / 2 with
    # p_i . x >= 1, whence s = 1 / |x|.
    scale = np.abs(points).max()
    unit = points / scale
    x, _, flag, _ = daqp.solve(
        np.eye(3), np.zeros(3), np.ascontiguousarray(unit), np.full(len(unit), 1e30),
        np.ones(len(unit)), np.zeros(len(unit), dtype=np.int32), primal_tol=1e-12, dual_tol=1e-12,
    )  # fmt: skip
    if flag != 1 or not np.isfinite(x).all():  # no plane between: the origin is in a flat hull
        return 0.0
    return float(scale / np.linalg.norm(x))


_PROBLEMS: dict[tuple[int, int], tuple[cp.Problem, cp.Parameter, cp.Parameter]] = {}


def _by_cones(a: Shape, b: Shape, R: Array, t: Array) -> float:
    """Distance, at least 0, as a second-order cone program."""
    key = (id(a), id(b))
    if key not in _PROBLEMS:
        x = cp.Variable(3)
        y = cp.Variable(3)
        turn = cp.Parameter((3, 3))
        shift = cp.Parameter(3)
        rules = _membership(a, x) + _membership(b, y)
        # In decimetres, so that the solver's tolerances are relative to something of size one.
        problem = cp.Problem(cp.Minimize(cp.norm(10 * (turn @ y + shift - x))), rules)
        _PROBLEMS[key] = problem, turn, shift
    problem, turn, shift = _PROBLEMS[key]
    turn.value = R
    shift.value = t
    tight = dict.fromkeys(("tol_gap_abs", "tol_gap_rel", "tol_feas"), 1e-11)
    with warnings.catch_warnings():  # "may be inaccurate": judged by the comparison itself
        warnings.simplefilter("ignore")
        problem.solve(solver="CLARABEL", **tight)
    return float(problem.value) / 10


def _membership(solid: Shape, x: cp.Variable) -> list[cp.Constraint]:
    match solid:
        case Box():
            return [cp.abs(x) <= solid.half_extents]
        case ConvexMesh():
            weights = cp.Variable(len(solid.vertices), nonneg=True)
            return [x == solid.vertices.T @ weights, cp.sum(weights) == 1]
        case Capsule():
            s = cp.Variable()
            off = cp.hstack([x[0], x[1], x[2] - s])
            return [cp.norm(off) <= solid.radius, cp.abs(s) <= solid.half_length]
        case Cylinder():
            return [cp.norm(x[:2]) <= solid.radius, cp.abs(x[2]) <= solid.half_length]
        case Cone():
            slope = solid.radius / (2 * solid.half_length)
            return [
                cp.norm(x[:2]) <= slope * (solid.half_length - x[2]),
                x[2] >= -solid.half_length,
            ]
        case Ellipsoid():
            return [cp.norm(x / solid.half_axes) <= 1]
        case _:
            raise AssertionError(solid)
