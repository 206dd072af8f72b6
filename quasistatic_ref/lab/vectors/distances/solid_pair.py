"""Closest points of two solids in exact numbers, by the method that suits them."""

from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.curved_pair import (
    cylinder_and_curved,
    polytope_and_curved,
)
from quasistatic_ref.lab.vectors.distances.plane_distance import solid_on_plane
from quasistatic_ref.lab.vectors.distances.point_distance import point_on_solid
from quasistatic_ref.lab.vectors.distances.polytope_pair import polytope_pair
from quasistatic_ref.lab.vectors.distances.shapes import Core, Placed, core, placed_shape
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import Vector
from quasistatic_ref.lab.vectors.expected import Json

CLOSED_FORMS = ("box", "cylinder", "cone", "ellipsoid", "halfspace")
"""Shapes whose distance to a point has one of its own; that to the others is a polytope's."""


def witnesses(case: Json) -> list[Witness]:
    """Closest points of the two shapes of a case, one for each point of a cloud.

    Raises
    ------
    InputError
        If both are clouds or half-spaces, or there is no closed form and no enclosure.
    """
    a, b = (placed_shape(case[side], case[f"pose_{side}"]) for side in ("alpha", "beta"))
    if a.kind == b.kind and a.kind in ("cloud", "halfspace"):
        raise InputError(f"two {a.kind}s have no distance", field="alpha, beta", value=a.kind)
    if b.kind == "cloud":
        return [point_witness(a, b.world(x)) for x in b.points]
    if a.kind == "cloud":
        return [point_witness(b, a.world(x)).swapped() for x in a.points]
    return [pair_witness(a, b)]


def point_witness(solid: Placed, point: Vector) -> Witness:
    """Closest point of a solid, which is alpha's, to a point of the world."""
    if solid.kind in CLOSED_FORMS:
        return point_on_solid(solid, point)
    flat = core(solid)
    assert flat is not None
    return polytope_pair(flat, Core(fmpq(0), [point], [], [], []))


def pair_witness(a: Placed, b: Placed) -> Witness:
    """Closest points of two placed solids; InputError as for `witnesses`."""
    if b.kind == "sphere":
        return point_witness(a, b.t).inflated(fmpq(0), b.sizes[0])
    if a.kind == "sphere":
        return point_witness(b, a.t).inflated(fmpq(0), a.sizes[0]).swapped()
    if a.kind == "halfspace":
        return solid_on_plane(a, b)
    if b.kind == "halfspace":
        return solid_on_plane(b, a).swapped()
    flat_a = core(a)
    flat_b = core(b)
    if flat_a is not None and flat_b is not None:
        return polytope_pair(flat_a, flat_b)
    if flat_a is not None:
        return polytope_and_curved(flat_a, b)
    if flat_b is not None:
        return polytope_and_curved(flat_b, a).swapped()
    if a.kind == "cylinder":
        return cylinder_and_curved(a, b)
    if b.kind == "cylinder":
        return cylinder_and_curved(b, a).swapped()
    raise InputError("this pair has no closed form", field="alpha, beta", value=[a.kind, b.kind])
