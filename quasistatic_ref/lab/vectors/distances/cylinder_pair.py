"""Closest points of a cylinder and another curved solid that are apart.

As for a polytope, each feature of the cylinder has its candidates, and one that is a normal of the
cylinder is the answer. The side is the axis with a ball about every point; a cap has the farthest
point of the other solid towards it; along a rim the distance has its minima between points where
its derivative changes from falling to rising.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.curved_pair import flat_of, outside, shares_a_way, slope
from quasistatic_ref.lab.vectors.distances.plane_distance import SUPPORTS
from quasistatic_ref.lab.vectors.distances.point_distance import point_on_solid
from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.stationary import minimum
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.algebra import IDENTITY, Vector, length
from quasistatic_ref.lab.vectors.exact.precision import Real, cos_sin, rational_near, sign

SECTORS = 48
"""Parts of a rim: its distance to a convex solid has few minima, far apart."""

QUARTER = fmpq(13, 8)
"""A little more than a quarter of a turn [rad]."""


def cylinder_and_curved(cylinder: Placed, other: Placed) -> Witness:
    """Closest points of a cylinder, which is alpha's, and a cylinder, cone or ellipsoid.

    Raises
    ------
    InputError
        If the solids meet.
    """
    for candidate in _candidates(cylinder, other):
        if sign(candidate.phi) > 0 and _is_normal(cylinder, candidate):
            ways = flat_of(cylinder, candidate.n)
            unique = not shares_a_way(ways, flat_of(other, -candidate.n))
            return replace(candidate, unique=unique)
    raise InputError(
        "the solids meet, where this pair has no closed form",
        field="alpha, beta",
        value=[cylinder.kind, other.kind],
    )


def _candidates(cylinder: Placed, other: Placed) -> Iterator[Witness]:
    radius, half = cylinder.sizes
    axis = cylinder.world_direction(IDENTITY[2])
    at = minimum(partial(slope, other, cylinder.t, axis), -half, half)
    if at is not None and outside(other, cylinder.t + rational_near(at) * axis):
        core = point_on_solid(other, cylinder.t + at * axis).swapped()
        yield core.inflated(radius, fmpq(0))
    for end in (1, -1):
        n = end * axis
        centre = cylinder.t + half * n
        support, _ = SUPPORTS[other.kind](other.sizes, other.local_direction(-n))
        beta = other.world(support)
        phi = n @ beta - n @ centre
        yield Witness(phi, beta - phi * n, beta, n, True)
        yield point_on_solid(other, centre).swapped()
        yield from _on_rim(cylinder, centre, other)


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
            if outside(other, np.array([rational_near(x) for x in point])):
                yield point_on_solid(other, point).swapped()


def _is_normal(cylinder: Placed, found: Witness) -> bool:
    """Whether alpha is a point of the cylinder, and n a normal of it there."""
    at = cylinder.local(found.alpha)
    n = cylinder.local_direction(found.n)
    radius, half = cylinder.sizes
    if sign(length(at[:2]) - radius) > 0 or sign(abs(at[2]) - half) > 0:
        return False
    # The support function, reached at alpha: n is a normal there.
    reach = radius * length(n[:2]) + half * abs(n[2])
    return sign(reach - n @ at) == 0
