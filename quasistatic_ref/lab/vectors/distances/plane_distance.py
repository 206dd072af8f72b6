"""Closest points of a half-space and a bounded solid: its lowest point."""

from collections.abc import Callable
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
        found = point_on_solid(plane, flat.vertices[lowest])
        alone = replace(found, unique=heights.count(max(heights)) == 1)
        return alone.inflated(fmpq(0), flat.margin)
    point, unique = SUPPORTS[solid.kind](solid.sizes, solid.local_direction(down))
    return replace(point_on_solid(plane, solid.world(point)), unique=unique)


def cylinder_support(sizes: Vector, d: Vector) -> tuple[Vector, bool]:
    """Farthest point of a cylinder; the middle of a cap or a side that is all as far."""
    across, rim = _rim(sizes[0], d)
    height = sign(d[2])
    return np.append(rim, height * sizes[1]), across and height != 0


def cone_support(sizes: Vector, d: Vector) -> tuple[Vector, bool]:
    """Farthest point of a cone: the tip, or a point of the rim."""
    across, rim = _rim(sizes[0], d)
    tip = sizes[1] * IDENTITY[2]
    base = np.append(rim, -sizes[1])
    higher = sign(d @ tip - d @ base)
    return (tip, True) if higher > 0 else (base, across and higher < 0)


def ellipsoid_support(sizes: Vector, d: Vector) -> tuple[Vector, bool]:
    """Farthest point of an ellipsoid."""
    stretched = sizes * d
    return sizes * stretched / length(stretched), True


SUPPORTS: dict[str, Callable[[Vector, Vector], tuple[Vector, bool]]] = {
    "cylinder": cylinder_support,
    "cone": cone_support,
    "ellipsoid": ellipsoid_support,
}
"""Farthest point along a direction, in the shape's own frame, and whether it is the only one."""


def _rim(radius: Real, d: Vector) -> tuple[bool, Vector]:
    across = length(d[:2])
    if sign(across) == 0:
        return False, ZERO[:2]
    return True, radius / across * d[:2]
