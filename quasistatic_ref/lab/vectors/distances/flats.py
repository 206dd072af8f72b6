"""Flat parts of curved solids: the caps and generators that lie at right angles to a direction."""

from __future__ import annotations

from collections.abc import Sequence

from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.exact.algebra import IDENTITY, Vector, cross, dot, squared
from quasistatic_ref.lab.vectors.exact.precision import root, sign


def flat_of(solid: Placed, direction: Vector) -> list[Vector]:
    """Directions that span what of a solid is farthest along another: none, one or two.

    A cylinder or cone has its cap (two), a generator (one) or a point there.
    """
    d = solid.local_direction(direction)
    flat: list[Vector] = []
    radial = root(squared(d[:2]))
    if solid.kind == "ellipsoid":
        return flat
    if sign(radial) == 0:
        if solid.kind == "cylinder" or sign(d[2]) < 0:
            flat = IDENTITY[:2]
    elif solid.kind == "cylinder":
        flat = IDENTITY[2:] if sign(d[2]) == 0 else []
    else:
        radius, half = solid.sizes
        slant = [-radius * x / radial for x in d[:2]]
        generator = [*slant, 2 * half]
        flat = [generator] if sign(dot(generator, d)) == 0 else []
    return [solid.world_direction(way) for way in flat]


def shares_a_way(a: Sequence[Vector], b: Sequence[Vector]) -> bool:
    """Whether two spans of at most two directions, in one plane, have a direction in common."""
    if not a or not b:
        return False
    if len(a) + len(b) > 2:
        return True
    return all(sign(x) == 0 for x in cross(a[0], b[0]))
