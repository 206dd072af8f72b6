"""Closest points of a polytope or cylinder and a curved solid that are apart: closed forms.

Two points of two convex solids are closest if and only if the line between them is a normal of
both. So each feature of the one has a candidate: a vertex its own closest point; a face, or a
cap, the farthest point of the curved solid towards it; along an edge, the axis or a rim the
distance of a point, which is a closed form, has its minimum. The candidate that the solid's
support function proves is the answer. (coal's normals are off by 1e-6, near contact by 1e-4.)
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.placed import Placed, Witness
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.shapes.placed_shape import Capsule, Cylinder
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import PROVED

SETTLED = 4e-16
"""Defect, relative to the coordinates, of a candidate after which no other is tried."""

SECTORS = 48
"""Parts of a rim: its distance to a convex solid has few minima, far apart."""

SECANTS, STEPS = 20, 80
"""Refinements of a minimum by secants, and in all; about ten are usual."""


class Candidates(NamedTuple):
    """Points of one solid and what the other is from there, in the other's frame.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        [m].
    phi : ndarray, shape (N,)
        Distance of the other solid [m].
    normal : ndarray, shape (N, 3)
        Its outward unit normal.
    """

    points: Array
    phi: Array
    normal: Array


def curved_witness(a: Placed, b: Placed) -> Witness | None:
    """Closest points in the world frame; None where the solids meet or neither has such features.

    Parameters
    ----------
    a, b : Placed
        Bounded, and no spheres.
    """
    # A polytope first: a capsule's margin may reach a solid that its axis does not.
    if polytope(a.shape) is not None:
        return _witness(a, b)
    if polytope(b.shape) is not None or not isinstance(a.shape, Cylinder):
        found = _witness(b, a)
        return None if found is None else found.swapped()
    return _witness(a, b)


def _witness(a: Placed, b: Placed) -> Witness | None:
    if polytope(a.shape) is None and not isinstance(a.shape, Cylinder):
        return None
    R, t = b.R.T @ a.R, b.R.T @ (a.t - b.t)
    margin = a.shape.radius if isinstance(a.shape, Capsule) else 0.0
    best, least = None, np.inf
    for points, phi, normal in _candidates(a, b, R, t):
        if not len(phi):
            continue
        # No gap along a normal exceeds the distance: who equals its gap proves itself.
        reach = a.shape.support_value(-normal @ R) - margin - np.sum(normal * t, axis=1)
        defect = np.abs(phi + reach + b.shape.support_value(normal))
        defect = np.maximum(defect, signed_distance(a.shape, (points - t) @ R)[0] + margin)
        defect[phi <= 0] = np.inf
        defect /= np.abs(points).max() + np.abs(t).max()
        k = int(defect.argmin())
        if defect[k] < least:
            best, least = (points[k], float(phi[k]), -normal[k]), float(defect[k])
        if least <= SETTLED:
            break
    if best is None or not least <= PROVED:
        return None
    point, distance, way = best
    alpha, n = b.R @ point + b.t, b.R @ way
    return Witness(distance - margin, alpha + margin * n, alpha + distance * n, n)


def _candidates(a: Placed, b: Placed, R: Array, t: Array) -> Iterator[Candidates]:
    if isinstance(a.shape, Cylinder):
        yield from _of_cylinder(a.shape, b, R, t)
        return
    flat = polytope(a.shape)
    assert flat is not None
    vertices = flat.vertices @ R.T + t
    first, last = vertices[flat.edges[:, 0]], vertices[flat.edges[:, 1]]
    yield _from(b, vertices)
    yield _along(b, first, last - first)
    if not isinstance(a.shape, Capsule):
        normals = flat.normals @ R.T
        yield _towards(b, normals, flat.offsets + normals @ t)


def _of_cylinder(cylinder: Cylinder, b: Placed, R: Array, t: Array) -> Iterator[Candidates]:
    axis = R[:, 2]
    ends = t + np.outer([1.0, -1.0], cylinder.half_length * axis)
    ways = np.stack([axis, -axis])
    yield _from(b, ends)
    yield _towards(b, ways, cylinder.half_length + ways @ t)
    core = _along(b, ends[1:], ends[:1] - ends[1:])
    # The side is the axis with a ball about every point.
    points = core.points - cylinder.radius * core.normal
    yield Candidates(points, core.phi - cylinder.radius, core.normal)
    step = 2 * np.pi / SECTORS
    angle = np.asarray(step * np.arange(SECTORS), dtype=np.float64)
    for end in ends:

        def rim(theta: Array, end: Array = end) -> Array:
            way = np.outer(np.cos(theta), R[:, 0]) + np.outer(np.sin(theta), R[:, 1])
            return np.asarray(end + cylinder.radius * way)

        def rise(theta: Array, rim: Callable[[Array], Array] = rim) -> Array:
            forward = np.outer(np.cos(theta), R[:, 1]) - np.outer(np.sin(theta), R[:, 0])
            return np.asarray(np.sum(signed_distance(b.shape, rim(theta))[1] * forward, axis=1))

        yield _from(b, rim(_roots(rise, angle, np.asarray(angle + step))))


def _from(b: Placed, points: Array) -> Candidates:
    return Candidates(points, *signed_distance(b.shape, points))


def _along(b: Placed, starts: Array, ways: Array) -> Candidates:
    """The nearest points within segments."""

    def slope(s: Array, k: NDArray[np.int64]) -> Array:
        normal = signed_distance(b.shape, starts[k] + s[:, None] * ways[k])[1]
        return np.asarray(np.sum(normal * ways[k], axis=1))

    every = np.arange(len(starts), dtype=np.int64)
    zero, one = np.zeros(len(starts)), np.ones(len(starts))
    k = every[(slope(zero, every) < 0) & (slope(one, every) > 0)]
    s = _roots(lambda s: slope(s, k), zero[k], one[k])
    found = _from(b, starts[k] + s[:, None] * ways[k])
    return found._replace(normal=_across(found.normal, ways[k]))


def _across(normal: Array, ways: Array) -> Array:
    """Normals made perpendicular to an edge: near contact they are off by more than the rest."""
    ways = ways / np.sqrt(np.sum(ways * ways, axis=1))[:, None]
    across = normal - np.sum(normal * ways, axis=1)[:, None] * ways
    length = np.sqrt(np.sum(across * across, axis=1))[:, None]
    # At a kink of the distance, inside, nothing may be left: no candidate, whatever its normal.
    return np.where(length > 0, across / np.where(length > 0, length, 1.0), normal)


def _towards(b: Placed, ways: Array, offsets: Array) -> Candidates:
    """From planes ways @ x = offsets to the farthest points of a solid towards them."""
    lowest = np.array([b.shape.support_point(-way) for way in ways])
    gap = np.sum(ways * lowest, axis=1) - offsets
    return Candidates(lowest - gap[:, None] * ways, gap, -ways)


def _roots(function: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Where functions that rise through zero in brackets do; others are left out.

    The Illinois method for all brackets at once; where it is not done soon, halving.
    """
    if not len(low):
        return low
    f_low, f_high = function(low), function(high)
    rising = (f_low < 0) & (f_high > 0)
    if not rising.any():
        return low[:0]
    low, high = low.copy(), high.copy()
    best = low.copy()
    for step in range(1, STEPS):
        span = f_high - f_low
        share = np.where(span > 0, -f_low / np.where(span > 0, span, 1.0), 0.5)
        at = low + (share if step < SECANTS else 0.5) * (high - low)
        at = np.clip(at, low, high)
        value = function(at)
        done = np.abs(at - best) <= 2 * np.spacing(np.abs(low) + np.abs(high))
        best = at
        if (done | ~rising | (value == 0)).all():
            break
        below = value < 0
        f_high = np.where(below, f_high / 2, value)
        f_low = np.where(below, value, f_low / 2)
        low, high = np.where(below, at, low), np.where(below, high, at)
    return np.asarray(best[rising])
