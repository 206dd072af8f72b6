"""Closest points of a polytope and a cylinder, cone or ellipsoid that are apart.

Two points of two convex solids are closest if and only if the line between them is a normal of
both. So each feature of the polytope has one candidate, the curved solid's closed forms tell its
other end, and the candidate that is a normal of the polytope is the answer: a proof, not a search.
A vertex has its own closest point; a face the farthest point of the curved solid towards it; on an
edge the distance is convex, and its minimum is enclosed by bisection.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.plane_distance import SUPPORTS
from quasistatic_ref.lab.vectors.distances.point_distance import point_on_solid
from quasistatic_ref.lab.vectors.distances.shapes import Core, Placed
from quasistatic_ref.lab.vectors.distances.stationary import minimum
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.algebra import IDENTITY, Vector, length
from quasistatic_ref.lab.vectors.exact.precision import Real, rational_near, sign


def polytope_and_curved(flat: Core, curved: Placed) -> Witness:
    """Closest points of a polytope with a margin, which is alpha's, and a curved solid.

    Raises
    ------
    InputError
        If the polytope without its margin meets the curved solid.
    """
    for candidate in _candidates(flat, curved):
        if sign(candidate.phi) > 0 and _is_normal(flat, candidate):
            found = _with_uniqueness(flat, curved, candidate)
            return found.inflated(flat.margin, fmpq(0))
    raise InputError(
        "the solids meet, where this pair has no closed form",
        field="alpha, beta",
        value=["polytope", curved.kind],
    )


def _candidates(flat: Core, curved: Placed) -> Iterator[Witness]:
    for vertex in flat.vertices:
        yield point_on_solid(curved, vertex).swapped()
    for normal in flat.normals:
        yield _on_face(flat, normal, curved)
    for first, last in flat.sides:
        start = flat.vertices[first]
        way = flat.vertices[last] - start
        at = minimum(partial(slope, curved, start, way), fmpq(0), fmpq(1))
        if at is not None and outside(curved, start + rational_near(at) * way):
            yield point_on_solid(curved, start + at * way).swapped()


def outside(solid: Placed, point: Vector) -> bool:
    """Whether a rational point is outside: inside, the distance has kinks that no ball decides."""
    return sign(point_on_solid(solid, point).phi) > 0


def slope(curved: Placed, start: Vector, way: Vector, at: Real) -> Real:
    """Derivative along a line of the distance to a solid: it increases, as that is convex."""
    return point_on_solid(curved, start + at * way).n @ way


def _on_face(flat: Core, normal: Vector, curved: Placed) -> Witness:
    """From the plane of a face to the farthest point of the curved solid towards it."""
    support, _ = SUPPORTS[curved.kind](curved.sizes, curved.local_direction(-normal))
    beta = curved.world(support)
    phi = (normal @ beta - max(normal @ x for x in flat.vertices)) / length(normal)
    n = normal / length(normal)
    return Witness(phi, beta - phi * n, beta, n, True)


def _is_normal(flat: Core, found: Witness) -> bool:
    """Whether alpha is a point of the polytope, and n a normal of it there."""
    reach = found.n @ found.alpha
    if any(sign(found.n @ x - reach) > 0 for x in flat.vertices):
        return False
    for normal in flat.normals:
        face = max(normal @ x for x in flat.vertices)
        if sign(normal @ found.alpha - face) > 0:
            return False
    return True


def _with_uniqueness(flat: Core, curved: Placed, found: Witness) -> Witness:
    """Not unique are the points where flat parts of both solids lie in each other."""
    reach = found.n @ found.alpha
    highest = [x for x in flat.vertices if sign(found.n @ x - reach) == 0]
    ways = _independent([x - highest[0] for x in highest[1:]])
    unique = not shares_a_way(ways, flat_of(curved, -found.n))
    return replace(found, unique=unique)


def _independent(ways: Sequence[Vector]) -> list[Vector]:
    """At most two directions that span the same as those given."""
    if not ways:
        return []
    others = [way for way in ways[1:] if any(np.cross(ways[0], way))]
    return [ways[0], *others[:1]]


def flat_of(solid: Placed, direction: Vector) -> Sequence[Vector]:
    """Directions that span what of a curved solid is farthest along another: none, one or two.

    A cylinder or cone has its cap (two), a generator (one) or a point there.
    """
    d = solid.local_direction(direction)
    flat: Sequence[Vector] = []
    radial = length(d[:2])
    if solid.kind == "ellipsoid":
        return flat
    if sign(radial) == 0:
        if solid.kind == "cylinder" or sign(d[2]) < 0:
            flat = IDENTITY[:2]
    elif solid.kind == "cylinder":
        flat = IDENTITY[2:] if sign(d[2]) == 0 else []
    else:
        radius, half = solid.sizes
        generator = np.append(-radius / radial * d[:2], 2 * half)
        flat = [generator] if sign(generator @ d) == 0 else []
    return [solid.world_direction(way) for way in flat]


def shares_a_way(a: Sequence[Vector], b: Sequence[Vector]) -> bool:
    """Whether two spans of at most two directions, in one plane, have a direction in common."""
    if not len(a) or not len(b):
        return False
    if len(a) + len(b) > 2:
        return True
    return all(sign(x) == 0 for x in np.cross(a[0], b[0]))
