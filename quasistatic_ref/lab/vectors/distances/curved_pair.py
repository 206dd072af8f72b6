"""Closest points of a polytope or a cylinder and a curved solid that are apart.

Two points of two convex solids are closest if and only if the line between them is a normal of
both. So each feature of the one solid has its candidates, the curved solid's closed forms tell
their other ends, and the candidate that is a normal of the one solid is the answer: a proof, not a
search.

Of a polytope a vertex has its own closest point; a face the farthest point of the curved solid
towards it; on an edge the distance is convex, and its minimum is enclosed by bisection. Of a
cylinder the side is the axis with a ball about every point, and a cap is a face; along a rim the
distance has its minima between points where its derivative changes from falling to rising.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.plane_distance import SUPPORTS, flat_of
from quasistatic_ref.lab.vectors.distances.point_distance import point_on_solid
from quasistatic_ref.lab.vectors.distances.shapes import Core, Placed
from quasistatic_ref.lab.vectors.distances.stationary import minimum
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import (
    IDENTITY,
    Real,
    Vector,
    cos_sin,
    length,
    rational_near,
    sign,
)

SECTORS = 48
"""Parts of a rim: its distance to a convex solid has few minima, far apart."""

QUARTER = fmpq(13, 8)
"""A little more than a quarter of a turn [rad]."""


def polytope_and_curved(flat: Core, curved: Placed) -> Witness:
    """Closest points of a polytope with a margin, which is alpha's, and a curved solid.

    Raises
    ------
    InputError
        If the polytope without its margin meets the curved solid.
    """
    witness = _normal_of_both(
        _of_polytope(flat, curved), partial(_is_normal_of_polytope, flat), "polytope", curved.kind
    )
    # Not unique are the points where flat parts of both solids lie in each other.
    reach = witness.n @ witness.alpha
    highest = [x for x in flat.vertices if sign(witness.n @ x - reach) == 0]
    ways = _independent([x - highest[0] for x in highest[1:]])
    unique = not _shares_a_way(ways, flat_of(curved, -witness.n))
    return replace(witness, unique=unique).inflated(flat.margin, fmpq(0))


def cylinder_and_curved(cylinder: Placed, other: Placed) -> Witness:
    """Closest points of a cylinder, which is alpha's, and a cylinder, cone or ellipsoid.

    Raises
    ------
    InputError
        If the solids meet.
    """
    witness = _normal_of_both(
        _of_cylinder(cylinder, other), partial(_is_normal_of_cylinder, cylinder),
        cylinder.kind, other.kind,
    )  # fmt: skip
    unique = not _shares_a_way(flat_of(cylinder, witness.n), flat_of(other, -witness.n))
    return replace(witness, unique=unique)


def _normal_of_both(
    candidates: Iterable[Witness], is_normal: Callable[[Witness], bool], *kinds: str
) -> Witness:
    """The candidate that is a normal of alpha's solid, too."""
    for candidate in candidates:
        if sign(candidate.phi) > 0 and is_normal(candidate):
            return candidate
    problem = "the solids meet, where this pair has no closed form"
    raise InputError(problem, field="alpha, beta", value=list(kinds))


def _of_polytope(flat: Core, curved: Placed) -> Iterator[Witness]:
    for vertex in flat.vertices:
        yield point_on_solid(curved, vertex).swapped()
    for normal in flat.normals:
        yield _on_face(max(normal @ x for x in flat.vertices), normal, curved)
    for first, last in flat.sides:
        start = flat.vertices[first]
        way = flat.vertices[last] - start
        at = minimum(partial(_slope, curved, start, way), fmpq(0), fmpq(1))
        if at is not None and _outside(curved, start + rational_near(at) * way):
            yield point_on_solid(curved, start + at * way).swapped()


def _of_cylinder(cylinder: Placed, other: Placed) -> Iterator[Witness]:
    radius, half = cylinder.sizes
    axis = cylinder.world_direction(IDENTITY[2])
    at = minimum(partial(_slope, other, cylinder.t, axis), -half, half)
    if at is not None and _outside(other, cylinder.t + rational_near(at) * axis):
        core = point_on_solid(other, cylinder.t + at * axis).swapped()
        yield core.inflated(radius, fmpq(0))
    for end in (1, -1):
        n = end * axis
        centre = cylinder.t + half * n
        yield _on_face(n @ centre, n, other)
        yield point_on_solid(other, centre).swapped()
        yield from _on_rim(cylinder, centre, other)


def _outside(solid: Placed, point: Vector) -> bool:
    """Whether a rational point is outside: inside, the distance has kinks that no ball decides."""
    return sign(point_on_solid(solid, point).phi) > 0


def _slope(curved: Placed, start: Vector, way: Vector, at: Real) -> Real:
    """Derivative along a line of the distance to a solid: it increases, as that is convex."""
    return point_on_solid(curved, start + at * way).n @ way


def _on_face(height: Real, normal: Vector, curved: Placed) -> Witness:
    """From the plane normal @ x = height to the farthest point of a curved solid towards it."""
    support = SUPPORTS[curved.kind](curved.sizes, curved.local_direction(-normal))
    beta = curved.world(support)
    phi = (normal @ beta - height) / length(normal)
    n = normal / length(normal)
    return Witness(phi, beta - phi * n, beta, n, True)


def _on_rim(cylinder: Placed, centre: Vector, other: Placed) -> Iterator[Witness]:
    x_axis, y_axis, _ = (cylinder.world_direction(e) for e in IDENTITY)

    def radial(angle: Real) -> tuple[Vector, Vector]:
        """Way from the centre to the rim, and along it."""
        c, s = cos_sin(angle)
        way = c * x_axis + s * y_axis
        return cylinder.sizes[0] * way, c * y_axis - s * x_axis

    def rise(angle: Real) -> Real:
        way, forward = radial(angle)
        return point_on_solid(other, centre + way).n @ forward

    step = 4 * QUARTER / SECTORS
    angles = [step * k for k in range(SECTORS + 1)]
    signs = [sign(rise(angle)) for angle in angles]
    for k in range(SECTORS):
        at: Real | None = angles[k] if signs[k] == 0 else None
        if signs[k] < 0 < signs[k + 1]:
            at = minimum(rise, angles[k], angles[k + 1])
        if at is not None:
            point = centre + radial(at)[0]
            if _outside(other, np.array([rational_near(x) for x in point])):
                yield point_on_solid(other, point).swapped()


def _is_normal_of_polytope(flat: Core, witness: Witness) -> bool:
    """Whether alpha is a point of the polytope, and n a normal of it there."""
    reach = witness.n @ witness.alpha
    if any(sign(witness.n @ x - reach) > 0 for x in flat.vertices):
        return False
    for normal in flat.normals:
        face = max(normal @ x for x in flat.vertices)
        if sign(normal @ witness.alpha - face) > 0:
            return False
    return True


def _is_normal_of_cylinder(cylinder: Placed, witness: Witness) -> bool:
    """Whether alpha is a point of the cylinder, and n a normal of it there."""
    at = cylinder.local(witness.alpha)
    n = cylinder.local_direction(witness.n)
    radius, half = cylinder.sizes
    if sign(length(at[:2]) - radius) > 0 or sign(abs(at[2]) - half) > 0:
        return False
    # The support function, reached at alpha: n is a normal there.
    reach = radius * length(n[:2]) + half * abs(n[2])
    return sign(reach - n @ at) == 0


def _independent(ways: Sequence[Vector]) -> list[Vector]:
    """At most two directions that span the same as those given."""
    if not ways:
        return []
    others = [way for way in ways[1:] if any(np.cross(ways[0], way))]
    return [ways[0], *others[:1]]


def _shares_a_way(a: Sequence[Vector], b: Sequence[Vector]) -> bool:
    """Whether two spans of at most two directions, in one plane, have a direction in common."""
    if not len(a) or not len(b):
        return False
    if len(a) + len(b) > 2:
        return True
    return all(sign(x) == 0 for x in np.cross(a[0], b[0]))
