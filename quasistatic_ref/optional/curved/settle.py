"""A contact normal to rounding, from an approximate one: Newton's method on the gap.

The signed distance of two convex solids is the maximum over unit vectors n of the gap
s(n) = n . w(n), where w(n) leads from a's farthest point along n to b's along -n. At a maximum
n is on no kink of the two reaches, on one circle, on the crossing of two, or the normal of a flat
face; on each of these the gap is smooth, with first and second derivatives in closed form.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import combinations

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.optional.curved.faces import Face, curvature, face, placed_kinks

NEAR = 1e-3
"""Angle [rad] between an approximate normal and the kinks that are tried."""

STEPS = 30
"""Newton steps at most; three or four are usual."""

STRIDE = 0.1
"""Longest Newton step [rad]."""

CROSSING = 1e-9
"""Least sine of the angle between two circles' axes [-] whose crossing is a normal of its own."""

EYE = np.eye(2)

ROUNDS = 100
"""Alternating projections of a point onto two faces; one is usual."""

NOTHING = 1e-14
"""What rounding leaves of a slope, a curvature or a length, relative to the pair's size."""


def settled(a: ShapeInWorld, b: ShapeInWorld, start: Witness) -> Iterator[Witness]:
    """Maxima of the gap near an approximate one, one for each kink that is near.

    Parameters
    ----------
    a, b : ShapeInWorld
        Bounded, and no spheres.
    start : Witness
        Its normal right to about NEAR; its points say which of several are taken where two faces
        lie flat on each other.
    """
    settled_before: set[bytes] = set()
    for n in _normals(a, b, start.n):
        key = (n + 0.0).tobytes()
        if key in settled_before:
            continue
        settled_before.add(key)
        on_a = face(a, n)
        on_b = face(b, -n)
        alpha = _common(on_a, on_b, (start.alpha + start.beta) / 2)
        phi = float(n @ (on_b.corners[0] - alpha))
        yield Witness(phi, alpha, on_b.nearest(alpha), n)


def _normals(a: ShapeInWorld, b: ShapeInWorld, n: Array) -> Iterator[Array]:
    of_a = placed_kinks(a, n, NEAR)
    of_b = placed_kinks(b, -n, NEAR)
    yield from of_a.normals
    yield from -of_b.normals
    axes = np.concatenate([of_a.axes, -of_b.axes])
    levels = np.concatenate([of_a.levels, of_b.levels])
    circles = list(_distinct(axes, levels))
    for (u, c), (v, d) in combinations(circles, 2):
        across = _cross(u, v)
        sine = across @ across
        if sine > CROSSING**2:
            # The point of both planes nearest to the origin, and the way along both.
            middle = (_cross(v, across) * c + _cross(across, u) * d) / sine
            rest = 1 - middle @ middle
            if rest > 0:
                yield _unit(middle + np.sign(across @ n) * np.sqrt(rest / sine) * across)
    for u, c in circles:
        yield from _newton(n, partial(_on_circle, a, b, u, c))
    yield from _newton(n, partial(_on_sphere, a, b))


def _distinct(axes: Array, levels: Array) -> Iterator[tuple[Array, float]]:
    """Circles n . u = c, each once: (-u, -c) is the same circle as (u, c).

    Parallel edges have one circle. From -u and -c follow the same bits, but for signs of zeros.
    """
    known: set[bytes] = set()
    for u, c in zip(axes, levels, strict=True):
        circle = np.append(u, c)
        if (circle + 0.0).tobytes() not in known:
            known |= {(circle + 0.0).tobytes(), (0.0 - circle).tobytes()}
            yield u, c


def _newton(n: Array, step: Callable[[Array], tuple[Array, float] | None]) -> Iterator[Array]:
    """The limit of steps, which return the next n and the length of the step; None: no maximum."""
    last = np.inf
    for _ in range(STEPS):
        move = step(n)
        if move is None:
            return
        n, length = move
        # Down to rounding the steps shrink, there they stay as they are.
        if length >= last and length < 1e-9:
            break
        last = length
    yield n


def _on_sphere(a: ShapeInWorld, b: ShapeInWorld, n: Array) -> tuple[Array, float] | None:
    w = b.farthest(-n) - a.farthest(n)
    T = np.linalg.svd(n[None])[2][1:].T
    bends, ways = np.linalg.eigh(T.T @ (curvature(a, n) + curvature(b, -n)) @ T + n @ w * EYE)
    slopes = (ways.T @ T.T @ w).tolist()
    first, second = map(_turn, slopes, bends.tolist())
    if first is None or second is None:
        return None
    return _unit(n + T @ ways @ np.array([first, second])), max(abs(first), abs(second))


def _on_circle(
    a: ShapeInWorld, b: ShapeInWorld, u: Array, c: float, n: Array
) -> tuple[Array, float] | None:
    """Newton's step for the gap on the circle n = c u + s m, where m is a unit vector across u."""
    m = _unit(n - (n @ u) * u)
    s = np.sqrt(1 - c * c)
    t = _cross(u, m)
    n = c * u + s * m
    w = b.farthest(-n) - a.farthest(n)
    turn = _turn(float(t @ w), s * (t @ (curvature(a, n) + curvature(b, -n)) @ t) + m @ w)
    if turn is None:
        return None
    return _unit(c * u + s * (np.cos(turn) * m + np.sin(turn) * t)), abs(turn)


def _turn(slope: float, bend: float) -> float | None:
    """Newton's step to the maximum of a gap [rad]; none along a symmetry of both solids."""
    if max(abs(slope), abs(bend)) < NOTHING:
        return 0.0
    return float(min(max(slope / bend, -STRIDE), STRIDE)) if bend > 0 else None


def _common(on_a: Face, on_b: Face, x: Array) -> Array:
    """A point of a's face that b's face covers along n, near x; nearly so if there is none."""
    if len(on_a.corners) == len(on_b.corners) == 2:
        x = _crossing(on_a, on_b, x)
    best = x
    least = np.inf
    # Faces that touch each other's rims only are met from their middles.
    for start in (x, on_a.corners.mean(axis=0), on_b.corners.mean(axis=0)):
        alpha = on_a.nearest(start)
        for _ in range(ROUNDS):
            beta = on_b.nearest(alpha)
            away = beta - alpha
            miss = float(np.abs(away - (away @ on_a.n) * on_a.n).max())
            if miss < least:
                best = alpha
                least = miss
            before = alpha
            alpha = on_a.nearest(beta)
            if miss < NOTHING or (alpha == before).all():
                break
        if least < NOTHING:
            break
    return best


def _crossing(on_a: Face, on_b: Face, x: Array) -> Array:
    """Where the lines of two segments cross along n; of parallel ones, near x."""
    way_a = on_a.corners[1] - on_a.corners[0]
    way_b = on_b.corners[1] - on_b.corners[0]
    across = _cross(way_a, way_b)
    steep = across @ on_a.n
    if steep * steep <= CROSSING**2 * (way_a @ way_a) * (way_b @ way_b):
        return x
    share = _cross(on_b.corners[0] - on_a.corners[0], way_b) @ on_a.n / steep
    return np.asarray(on_a.corners[0] + share * way_a)


def _cross(u: Array, v: Array) -> Array:
    """U x v of vectors (3,): np.cross takes five times as long."""
    return np.asarray(crossed(u[None], v[None])[0])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.sqrt(vector @ vector))
