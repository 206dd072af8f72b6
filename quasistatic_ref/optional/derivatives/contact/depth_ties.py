"""Whether a body in penetration has two ways out that are equally short."""

import numpy as np

from quasistatic_ref.contact.separations import tied_normals
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.contact.solids.solid_pair import pair_and_gaps
from quasistatic_ref.contact.tied_faces import TURNED, faces_apart
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.contact.couples import Couple
from quasistatic_ref.optional.derivatives.tolerances import TIED
from quasistatic_ref.parts import needing
from quasistatic_ref.shapes.placed_shape import Ellipsoid, HalfSpace, PointCloud, Shape, Sphere

CURVED = "the derivative of a contact of curved solids"


def depth_tie(couple: Couple) -> bool:
    """Whether the normal of a contact in penetration is one of several.

    Of two curved solids that meet, it is one of those that the search for closest points followed.

    Parameters
    ----------
    couple : Couple
    """
    a, b = couple.of.bodies
    if isinstance(a.shape, HalfSpace) or isinstance(b.shape, HalfSpace):
        return False  # there is one way out of a half-space
    if couple.centre is not None:
        other, centre = couple.centre
        solid = couple.of.bodies[other]
        body = couple.of.bodies[1 - other].shape
        corner = not isinstance(body, PointCloud | Sphere)
        way = solid.R.T @ (couple.n if other == 0 else -couple.n) if corner else None
        return _inside_tie(solid.shape, solid.R.T @ (centre - solid.t), couple.of.size, way)
    if couple.phi > 0:
        return False
    within = TIED * couple.of.size
    if polytope(a.shape) is None or polytope(b.shape) is None:
        with needing(CURVED):
            from quasistatic_ref.optional.curved.by_coal import other_ways_out
        ways = other_ways_out(a, b, within)
        if any(np.abs(way - couple.n).max() > np.sqrt(TIED) for way in ways):
            return True
    elif couple.phi == 0:
        return False  # faces or edges that just touch are not in penetration
    nearest, every = pair_and_gaps(couple.of.pair.name, a, b)
    return len(tied_normals(a, b, nearest, within, every)) > 1


def _inside_tie(shape: Shape, p: Array, size: float, way: Array | None = None) -> bool:
    """Whether a point p (3,) [m] inside of a shape, in its frame, has several nearest points.

    A corner's normal is that of a face that faces the pair's: only such faces count if `way` (3,)
    is its normal, out of the shape.
    """
    near = TIED * size
    if isinstance(shape, Ellipsoid):
        return _on_medial_plane(shape, p, near)
    heights, normals = shape.faces(p[None])
    if way is not None:
        heights = np.where(normals @ way >= TURNED, heights, -np.inf)
    if not -np.inf < heights.max(initial=-np.inf) < 0:
        return False
    return bool(faces_apart(heights, normals, near)[1].any())


def _on_medial_plane(shape: Ellipsoid, p: Array, near: float) -> bool:
    """Whether p is on the disc from which the surface is as far above as below: it is inside."""
    e = shape.half_axes
    least = int(e.argmin())
    if abs(p[least]) > near:
        return False
    rest = [i for i in range(3) if i != least]
    spread = e[rest] ** 2 - e[least] ** 2
    if (spread <= 0).any():
        return bool((np.abs(p) <= near).all())
    return bool(np.sum((e[rest] * p[rest] / spread) ** 2) < 1)
