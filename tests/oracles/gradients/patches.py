"""Parts of surfaces by coordinates: a vertex, an edge, a face, a rim, a side, an ellipsoid.

Each knows a point of the world for its coordinates, and how the point moves with each of them, in
balls. Which part a closest point is on is read from float64; the rest is without rounding.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from flint import arb, fmpq

from quasistatic_ref.lab.vectors.distances.shapes import Core, Placed, core
from quasistatic_ref.lab.vectors.exact.algebra import (
    IDENTITY,
    Vector,
    along,
    cross,
    dot,
    scaled,
    squared,
    subtract,
)
from quasistatic_ref.lab.vectors.exact.precision import Real

NEAR: Final = 1e-9
"""How near to a part's end a point is on the end [m]; no random state is nearer by chance."""

Curve = Callable[[Vector], tuple[Vector, list[Vector]]]
"""From coordinates to a point and its derivatives by each of them."""


@dataclass(frozen=True)
class Patch:
    """A part of a surface in the world.

    Parameters
    ----------
    size : int
        Number of its coordinates, all 0 at the point that it was made at, or near it.
    at : callable
    margin : number
        Radius of the ball about every point [m].
    """

    size: int
    at: Curve
    margin: Real


def patch(solid: Placed, point: Vector, outward: Vector) -> Patch:
    """The part of a solid that a point is on, but for rounding.

    Parameters
    ----------
    solid : Placed
    point, outward : vector
        Of the surface, in the solid's own frame [m, -].
    """
    match solid.kind:
        case "box" | "convex" | "capsule":
            return _flat(solid, point, outward)
        case "cylinder":
            local = _of_cylinder(solid.sizes, point)
        case "cone":
            local = _of_cone(solid.sizes, point)
        case "ellipsoid":
            local = _ellipsoid(solid.sizes, point)
        case kind:
            raise ValueError(f"a {kind} has closed forms")
    return Patch(local.size, _in_world(solid, local.at), fmpq(0))


def _in_world(solid: Placed, curve: Curve) -> Curve:
    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        point, ways = curve(u)
        return solid.world(point), [solid.world_direction(way) for way in ways]

    return at


def _flat(solid: Placed, point: Vector, outward: Vector) -> Patch:
    """Of a polytope with a margin: the vertex, edge or face that is nearest."""
    flat = core(solid)
    assert flat is not None
    x = solid.world(along(point, outward, -flat.margin))
    for vertex in flat.vertices:
        if _length(subtract(vertex, x)) < NEAR:
            return _straight(vertex, [], flat.margin)
    for first, last in flat.sides:
        start = flat.vertices[first]
        way = _unit(subtract(flat.vertices[last], start))
        foot = along(start, way, dot(way, subtract(x, start)))
        if _length(subtract(foot, x)) < NEAR:
            return _straight(foot, [way], flat.margin)
    normal = min(flat.normals, key=lambda n: abs(_height(flat, n, x)))
    foot = along(x, _unit(normal), -_height(flat, normal, x))
    axis = min(IDENTITY, key=lambda e: abs(float(dot(e, normal))))
    one = _unit(cross(normal, axis))
    return _straight(foot, [one, _unit(cross(normal, one))], flat.margin)


def _straight(start: Vector, ways: list[Vector], margin: Real) -> Patch:
    """A vertex, an edge or a face, whichever has so many directions."""

    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        point = start
        for way, s in zip(ways, u, strict=True):
            point = along(point, way, s)
        return point, ways

    return Patch(len(ways), at, margin)


def _height(flat: Core, normal: Vector, x: Vector) -> Real:
    """How far a point is above the plane of a face."""
    top = max(dot(normal, vertex) for vertex in flat.vertices)
    return (dot(normal, x) - top) / arb(squared(normal)).sqrt()


def _length(x: Vector) -> float:
    return float(arb(squared(x)).sqrt())


def _unit(x: Vector) -> Vector:
    return scaled(x, 1 / arb(squared(x)).sqrt())


def _of_cylinder(sizes: Vector, point: Vector) -> Patch:
    radius, half = sizes
    r, z = _length(point[:2]), float(point[2])
    up = 1 if z > 0 else -1
    side, cap = r > float(radius) - NEAR, abs(z) > float(half) - NEAR
    if side and cap:
        return _rim(radius, half * up, point)
    if cap:
        return Patch(
            2, lambda u: ([point[0] + u[0], point[1] + u[1], half * up], IDENTITY[:2]), fmpq(0)
        )
    around = _rim(radius, point[2], point).at

    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        x, ways = around(u[:1])
        return along(x, IDENTITY[2], u[1]), [*ways, IDENTITY[2]]

    return Patch(2, at, fmpq(0))


def _of_cone(sizes: Vector, point: Vector) -> Patch:
    radius, half = sizes
    r, z = _length(point[:2]), float(point[2])
    if z > float(half) - NEAR:
        return Patch(0, lambda u: ([fmpq(0), fmpq(0), half], []), fmpq(0))
    if z < -float(half) + NEAR:
        if r > float(radius) - NEAR:
            return _rim(radius, -half, point)
        return Patch(
            2, lambda u: ([point[0] + u[0], point[1] + u[1], -half], IDENTITY[:2]), fmpq(0)
        )
    around = _rim(radius, -half, point).at

    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        """From the rim to the tip, which u[1] = 1 - z0 is."""
        (x, y, _), (way,) = around(u[:1])
        height = point[2] + u[1]
        share = (half - height) / (2 * half)
        slope = [-x / (2 * half), -y / (2 * half), fmpq(1)]
        return [x * share, y * share, height], [scaled(way, share), slope]

    return Patch(2, at, fmpq(0))


def _rim(radius: Real, height: Real, point: Vector) -> Patch:
    """A circle about the axis, its angle from that of a point."""
    x, y = _unit([arb(point[0]), arb(point[1])])

    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        c, s = arb(u[0]).cos(), arb(u[0]).sin()
        way = [-radius * (x * s + y * c), radius * (x * c - y * s), fmpq(0)]
        return [radius * (x * c - y * s), radius * (x * s + y * c), height], [way]

    return Patch(1, at, fmpq(0))


def _ellipsoid(half_axes: Vector, point: Vector) -> Patch:
    """The image of the unit sphere, by two coordinates of the plane that touches it at a point."""
    w = _unit([arb(x) / e for x, e in zip(point, half_axes, strict=True)])
    axis = min(range(3), key=lambda i: abs(float(w[i])))
    first = _unit(cross(w, IDENTITY[axis]))
    second = cross(w, first)

    def at(u: Vector) -> tuple[Vector, list[Vector]]:
        whole = along(along(w, first, u[0]), second, u[1])
        length = arb(squared(whole)).sqrt()
        on = scaled(whole, 1 / length)
        ways = [
            scaled(subtract(way, scaled(on, dot(on, way))), 1 / length) for way in (first, second)
        ]

        def image(x: Vector) -> Vector:
            return [e * value for e, value in zip(half_axes, x, strict=True)]

        return image(on), [image(way) for way in ways]

    return Patch(2, at, fmpq(0))
