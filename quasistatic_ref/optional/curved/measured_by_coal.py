"""Distances as coal gives them: ``distances = "coal"``.

A point of a cloud is a sphere of radius 0. For the solids of ``EXACT`` coal has closed forms of its
own; of two solids for those of ``ROUND``, with one contact. Its other distances are left out: the
general search behind them is off, inside a cylinder by centimetres, at cones and ellipsoids by
micrometres, and which normal it picks on a face of a box is not the model's rule.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import coal
import numpy as np

from quasistatic_ref.contact.normals import gaps
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, rotated
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

ROUND = (Sphere, Capsule, HalfSpace)
"""Solids whose distances to each other are, where their axes are apart."""

UNIT_LENGTH = 1e-10
"""Largest difference from 1 of the square of a unit normal's length [-]."""

RIGHT = 1e-14
"""Largest difference of a distance and the gap along its normal, relative to the larger solid [-],
that is rounding."""

ORIGIN = coal.Transform3s(np.eye(3), np.zeros(3))
POINT = coal.Sphere(0.0)


@dataclass(frozen=True, eq=False)
class MeasuredByCoal(Shape):
    """A solid whose distances are coal's; all else is the solid's own."""

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


def measured_witness(
    name: str, a: ShapeInWorld, b: ShapeInWorld, solids: tuple[Shape, Shape]
) -> Witness:
    """Closest points of two `solids` of ``ROUND`` as coal gives them, in the world frame.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    a, b : ShapeInWorld
        Where they are.
    solids : (Shape, Shape)

    Raises
    ------
    ContactError
        If coal has no normal: axes meet; or if the gap along its normal is not its distance, as of
        capsules whose axes are turned by less than 1e-3 rad, but are not parallel.
    """
    request = coal.DistanceRequest()
    request.enable_signed_distance = True
    result = coal.DistanceResult()
    one, other = map(geometry, solids)
    there = a.pose.of(b.pose)
    phi = coal.distance(one, ORIGIN, other, coal.Transform3s(there.R, there.t), request, result)
    n = rotated(a.R, np.asarray(result.normal).ravel())
    axes = [solid.radius for solid in solids if isinstance(solid, Sphere | Capsule)]
    bounded = len(axes) == 2
    size = max(a.shape.extent, b.shape.extent)
    meet = bounded and phi + sum(axes) <= RIGHT * size
    if meet or not abs(dot(n, n) - 1) <= UNIT_LENGTH:
        problem = 'their axes meet, where coal has no normal; use distances = "closed"'
        raise ContactError(problem, field=name)
    alpha = rotated(a.R, np.asarray(result.getNearestPoint1()).ravel()) + a.t
    if bounded:
        gap = gaps(a._replace(t=a.t - b.t), b._replace(t=0 * b.t), n[None])[0]
        if not abs(gap - phi) <= RIGHT * size:
            problem = f'coal\'s distance is off by {abs(gap - phi):.1g} m; use distances = "closed"'
            raise ContactError(problem, field=name)
    return Witness(float(phi), alpha, alpha + phi * n, n)


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
        If a pair is not of a cloud and a solid of ``EXACT``, or of two of ``ROUND`` with one
        contact.
    """
    return tuple(_pair_by_coal(pair) for pair in pairs)


def _pair_by_coal(pair: ContactPair) -> ContactPair:
    shapes = pair.alpha.shape, pair.beta.shape
    solids = [shape for shape in shapes if not isinstance(shape, PointCloud)]
    round_solids = all(isinstance(shape, ROUND) for shape in shapes) and pair.n_c == 1
    if not (round_solids or (pair.has_cloud and isinstance(solids[0], EXACT))):
        kinds = " and ".join(type(shape).__name__.lower() for shape in shapes)
        several = f" with k = {pair.n_c}" if pair.n_c > 1 else ""
        problem = (
            "coal's distances are right to rounding for clouds on boxes, spheres, capsules and "
            "half-spaces, and with k = 1 for spheres, capsules and half-spaces on each other, and "
            f'{pair.name} is of {kinds}{several}: use distances = "closed"'
        )
        raise ContactError(problem, field="distances", value="coal")
    return replace(pair, alpha=_side_by_coal(pair.alpha), beta=_side_by_coal(pair.beta))


def _side_by_coal(side: PlacedShape) -> PlacedShape:
    if isinstance(side.shape, PointCloud):
        return side
    return replace(side, shape=MeasuredByCoal(side.shape))
