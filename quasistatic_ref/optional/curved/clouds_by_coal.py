"""Distances of a cloud's points as coal gives them: ``distances = "coal"``.

A point is a sphere of radius 0. For the solids of ``EXACT`` coal has closed forms of its own. Its
other distances are left out, since the general search behind them is off: inside a cylinder by
centimetres, at cones and ellipsoids by micrometres.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import coal
import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
    Sphere,
)

EXACT = (Box, Sphere, Capsule, HalfSpace)
"""Solids to which coal's distances of points are right to rounding."""

UNIT_LENGTH = 1e-10
"""Largest difference from 1 of the square of a unit normal's length [-]."""

ORIGIN = coal.Transform3s(np.eye(3), np.zeros(3))
POINT = coal.Sphere(0.0)


@dataclass(frozen=True, eq=False)
class MeasuredByCoal(Shape):
    """A solid whose distances to points are coal's; all else is the solid's own."""

    solid: Shape

    @property
    def extent(self) -> float:
        """The extent of the solid [m]."""
        return self.solid.extent

    def faces(self, points: Array) -> tuple[Array, Array]:
        """The faces of the solid at `points`, shape (N, 3) [m]."""
        return self.solid.faces(points)

    def support_value(self, directions: Array) -> Array:
        """The reach of the solid along `directions`, shape (N, 3) [-]."""
        return self.solid.support_value(directions)

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Coal's distances and normals of `points`, shape (N, 3) [m], each point by itself.

        Raises
        ------
        ContactError
            If coal answers without a unit normal.
        """
        request = coal.DistanceRequest()
        request.enable_signed_distance = True
        result = coal.DistanceResult()
        solid = geometry(self.solid)
        phi = np.empty(len(points))
        n = np.empty((len(points), 3))
        for i, point in enumerate(points):  # coal takes one pair a call
            result.clear()
            there = coal.Transform3s(np.eye(3), point)
            phi[i] = coal.distance(solid, ORIGIN, POINT, there, request, result)
            n[i] = result.normal.ravel()
        if not (np.abs(dot(n, n) - 1) <= UNIT_LENGTH).all():
            problem = 'coal has no normal for one of its points; use distances = "closed"'
            raise ContactError(problem, field=type(self.solid).__name__.lower())
        return phi, n


@lru_cache(maxsize=256)
def geometry(solid: Shape) -> coal.CollisionGeometry:
    """A solid of ``EXACT`` as coal's own."""
    match solid:
        case Box():
            return coal.Box(2 * solid.half_extents)
        case Sphere():
            return coal.Sphere(solid.radius)
        case Capsule():
            return coal.Capsule(solid.radius, 2 * solid.half_length)
    assert isinstance(solid, HalfSpace)
    return coal.Halfspace(solid.normal, solid.offset)


def pairs_by_coal(pairs: tuple[ContactPair, ...]) -> tuple[ContactPair, ...]:
    """Pairs whose solids have their distances measured by coal.

    Raises
    ------
    ContactError
        If a pair is not of a cloud and a solid of ``EXACT``.
    """
    return tuple(_pair_by_coal(pair) for pair in pairs)


def _pair_by_coal(pair: ContactPair) -> ContactPair:
    shapes = pair.alpha.shape, pair.beta.shape
    solids = [shape for shape in shapes if not isinstance(shape, PointCloud)]
    if not (pair.has_cloud and isinstance(solids[0], EXACT)):
        kinds = " and ".join(type(shape).__name__.lower() for shape in shapes)
        problem = (
            "coal's distances are right to rounding for clouds on boxes, spheres, capsules and "
            f'half-spaces alone, and {pair.name} is of {kinds}: use distances = "closed"'
        )
        raise ContactError(problem, field="distances", value="coal")
    return replace(pair, alpha=_side_by_coal(pair.alpha), beta=_side_by_coal(pair.beta))


def _side_by_coal(side: PlacedShape) -> PlacedShape:
    if isinstance(side.shape, PointCloud):
        return side
    return replace(side, shape=MeasuredByCoal(side.shape))
