"""Signed distance, closest points and normal of two solids, each pair by its own method.

A sphere on anything, anything on a half-space, and every pair of box, convex mesh and capsule
have closed forms, right to rounding (a sphere on an ellipsoid: Newton's method, as accurate). For
all others, a cylinder, cone or ellipsoid and any of these or of those, ``optional/curved`` refines
and checks coal's answer.
"""

from collections.abc import Callable

from quasistatic_ref.contact.shape_in_world import Pose, ShapeInWorld, Witness
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.contact.solids.polytope_pair import polytope_pairs
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, product
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.placed_shape import HalfSpace, Sphere

WitnessOfPair = Callable[[str, ShapeInWorld, ShapeInWorld], Witness]
"""As :func:`solid_pair`."""


def solid_pair(name: str, a: ShapeInWorld, b: ShapeInWorld) -> Witness:
    """Closest points of two solids in the world frame.

    Where the normal is not unique, it is any one; a contact's is chosen by
    :func:`~quasistatic_ref.contact.normals.pair_normal`.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    a, b : ShapeInWorld
        Not two half-spaces.

    Raises
    ------
    ContactError
        If the pair is of the last kind, and coal's refined answer fails a check.
    """
    return pair_and_gaps(name, a, b, 0.0)[0]


def pair_and_gaps(
    name: str, a: ShapeInWorld, b: ShapeInWorld, within: float
) -> tuple[Witness, tuple[Array, Array] | None]:
    """A :func:`solid_pair`; of two polytopes also gaps (N,) [m] along normals (N, 3) [-].

    With all gaps that are within so much of the largest [m].
    """
    P = polytope(a.shape)
    Q = polytope(b.shape)
    if P is None or Q is None:
        return _curved_pair(name, a, b), None
    pose_a, pose_b = Pose(a.R[None], a.t[None]), Pose(b.R[None], b.t[None])
    points, (gaps, normals) = polytope_pairs(P.stack_of_one, Q.stack_of_one, pose_a, pose_b, within)
    phi, alpha, beta, n = points
    return Witness(float(phi[0]), alpha[0], beta[0], n[0]), (gaps[0], normals[0])


def _curved_pair(name: str, a: ShapeInWorld, b: ShapeInWorld) -> Witness:
    if isinstance(b.shape, Sphere):
        return _sphere_on_solid(a, b, b.shape.radius)
    if isinstance(a.shape, Sphere):
        return _sphere_on_solid(b, a, a.shape.radius).swapped()
    if isinstance(a.shape, HalfSpace):
        return _solid_on_plane(a, a.shape, b)
    if isinstance(b.shape, HalfSpace):
        return _solid_on_plane(b, b.shape, a).swapped()
    kinds = " and ".join(type(solid.shape).__name__.lower() for solid in (a, b))
    coal_witness: WitnessOfPair = part("coal_witness", f"{name}: contact of {kinds}")
    return coal_witness(name, a, b)


def _sphere_on_solid(solid: ShapeInWorld, sphere: ShapeInWorld, radius: float) -> Witness:
    distance, normal = solid.shape.signed_distance(product(sphere.t - solid.t, solid.R)[None])
    n = product(solid.R, normal[0])
    phi = float(distance[0])
    return Witness(phi - radius, sphere.t - phi * n, sphere.t - radius * n, n)


def _solid_on_plane(plane: ShapeInWorld, half_space: HalfSpace, solid: ShapeInWorld) -> Witness:
    n = product(plane.R, half_space.normal)
    lowest = solid.farthest(-n)
    phi = float(dot(n, lowest - plane.t) - half_space.offset)
    return Witness(phi, lowest - phi * n, lowest, n)
