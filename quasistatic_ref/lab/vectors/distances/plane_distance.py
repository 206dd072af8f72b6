"""Closest points of a half-space and a bounded solid: its lowest point."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.vectors.distances.point_distance import point_on_solid
from quasistatic_ref.lab.vectors.distances.shapes import Placed, core
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import IDENTITY, ZERO, Real, Vector, length, sign


def solid_on_plane(plane: Placed, solid: Placed) -> Witness:
    """Closest points of a half-space, which is alpha's, and a solid."""
    down = -plane.normal
    flat = core(solid)
    if flat is not None:
        heights = [down @ x for x in flat.vertices]
        lowest = heights.index(max(heights))
        witness = point_on_solid(plane, flat.vertices[lowest])
        alone = replace(witness, unique=heights.count(max(heights)) == 1)
        return alone.inflated(fmpq(0), flat.margin)
    point = SUPPORTS[solid.kind](solid.sizes, solid.local_direction(down))
    return replace(point_on_solid(plane, solid.world(point)), unique=not flat_of(solid, down))


def cylinder_support(sizes: Vector, d: Vector) -> Vector:
    """Farthest point of a cylinder; the middle of a cap or a side that is all as far."""
    return np.append(_rim(sizes[0], d), sign(d[2]) * sizes[1])


def cone_support(sizes: Vector, d: Vector) -> Vector:
    """Farthest point of a cone: the tip, or a point of the rim."""
    tip = sizes[1] * IDENTITY[2]
    base = np.append(_rim(sizes[0], d), -sizes[1])
    return tip if sign(d @ tip - d @ base) > 0 else base


def ellipsoid_support(sizes: Vector, d: Vector) -> Vector:
    """Farthest point of an ellipsoid."""
    stretched = sizes * d
    return sizes * stretched / length(stretched)


SUPPORTS: dict[str, Callable[[Vector, Vector], Vector]] = {
    "cylinder": cylinder_support,
    "cone": cone_support,
    "ellipsoid": ellipsoid_support,
}
"""Farthest point along a direction, in the shape's own frame: one of those of `flat_of`."""


def _rim(radius: Real, d: Vector) -> Vector:
    across = length(d[:2])
    return radius / across * d[:2] if sign(across) else ZERO[:2]


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
