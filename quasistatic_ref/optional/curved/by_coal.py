"""Closest points of pairs without a closed form: coal's answers, refined, believed with a proof.

For any unit vector n, the gap s(n) between two convex solids along n is at most their signed
distance. So points on both that are phi n apart, with s(n) = phi, prove themselves: apart, phi
is the distance; in penetration, n parts the solids after a translation by -phi. Answers are held
against that with closed-form support points, which never share coal's mistakes.

A gap that is proved to w proves its normal only to sqrt(2 w / phi): of points that are nearly in
contact it is the direction of a difference that cancels. So an answer has to prove its normal.

coal's tolerances are lengths. So a pair is enlarged or shrunk by a power of two, which rounds
nothing, until its size is about one; every number below is relative to that size.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Final, NamedTuple

import coal
import numpy as np

from quasistatic_ref.contact.normals import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.errors import ContactError, ModelError
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.curved.measured_by_coal import MeasuredByCoal, measured_witness
from quasistatic_ref.optional.curved.settle import settled
from quasistatic_ref.optional.curved.ways_out import rival_directions
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Box, Ellipsoid, Shape
from quasistatic_ref.shapes.revolved import Revolved

WITNESS: Final = 1e-10
"""Largest disagreement of a convex pair's closest points with its distance and normal, relative to
the pair's size [-]. Refined answers are at 1e-15; a wrong one disagrees by the size."""

PROVED_NORMAL: Final = 1e-6
"""Largest disagreement of a convex pair's closest points with its distance and normal, relative to
that distance [-]: the normal is right to about as much [rad]. Below 1e-14 of the pair's size it is
rounding."""

SUPPORT_DEFECT: Final = 1e-9
"""Difference between coal's distance and the gap along its normal, relative to the shapes' size, at
which its answer is taken at once [-]. What is right to rounding is at 1e-12 and below."""

ACCURACIES = (1e-10, 1e-8, 1e-6)
"""Tolerances of coal, tried in turn: the tighter ones sometimes end without an answer."""

CLEARANCE = 0.02
"""How far apart, relative to the depth, the solids are put to have a normal computed."""

LEAST = 1e-3
"""Added to that: where they just touch, their depth is nothing."""

SAME = 1 - 1e-4
"""Cosine above which two refined normals are the same way out."""

ENOUGH = 1e-14
"""Defect at which refining ends: rounding of the farthest points."""

BOX_TRIANGLES = np.array(
    [
        [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
        [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3],
        [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6],
    ]
)  # fmt: skip
"""Of a box's corners: two of each face, counter-clockwise from outside."""

MOST_NEIGHBOURS = 254
"""Most edges at a corner of a convex mesh of coal, which counts them in eight bits."""

UP = np.array([0.0, 0.0, 1.0])

ROUNDS = 30
"""Refinements of a normal in penetration; shallow ones settle in two or three."""


class Judged(NamedTuple):
    """Closest points of two solids, and a bound of their error.

    Attributes
    ----------
    defect : float
        |s(n) - phi| or the disagreement of the points, the larger [m].
    """

    @property
    def proves_its_normal(self) -> bool:
        """Whether the points are phi n apart to PROVED_NORMAL of phi, or to rounding.

        They miss that by e across n, so that n is right to about e / phi.
        """
        return self.defect <= min(WITNESS, max(ENOUGH, PROVED_NORMAL * abs(self.phi)))

    phi: float
    alpha: Array
    beta: Array
    n: Array
    defect: float


def coal_witness(name: str, a: ShapeInWorld, b: ShapeInWorld) -> Witness:
    """Signed distance, closest points and normal of two bounded convex solids, world frame.

    Raises
    ------
    ContactError
        If coal has no answer that proves itself.
    """
    if isinstance(a.shape, MeasuredByCoal) and isinstance(b.shape, MeasuredByCoal):
        return measured_witness(name, a, b, (a.shape.solid, b.shape.solid))
    best, scale = _answer(a, b)
    if not best.proves_its_normal:
        raise ContactError(
            "the contact normal is not reliable at this pose: move the bodies apart, or use a box, "
            "a capsule, a convex mesh or a cloud",
            field=name,
            value={"phi": best.phi / scale, "n": best.n.tolist()},
        )
    alpha = best.alpha / scale + a.t
    phi = float(best.phi / scale)
    return Witness(phi, alpha, alpha + phi * best.n, best.n)


def _answer(a: ShapeInWorld, b: ShapeInWorld) -> tuple[Judged, float]:
    """The best answer, and the factor of its lengths."""
    size = a.shape.extent + b.shape.extent + float(np.abs(b.t - a.t).max())
    scale = float(2.0 ** -np.round(np.log2(size)))
    here = ShapeInWorld(_resized(a.shape, scale), a.R, np.zeros(3))
    there = ShapeInWorld(_resized(b.shape, scale), b.R, scale * (b.t - a.t))
    best = _best(here, there, _by_coal(here, there))
    # Where they just touch, what is proved is right: no gap is wider than that of a contact.
    touching = best.phi >= -ENOUGH and best.defect <= WITNESS
    if best.phi > 0 or touching:
        return best, scale
    return _shallowest(here, there, best), scale


@lru_cache(maxsize=256)
def _resized(shape: Shape, scale: float) -> Shape:
    """The shape with all lengths multiplied; kept, for :func:`geometry`."""
    match shape:
        case Box():
            return Box(scale * shape.half_extents)
        case Revolved():
            return type(shape)(scale * shape.radius, scale * shape.half_length)
        case Ellipsoid():
            return Ellipsoid(scale * shape.half_axes)
        case ConvexMesh():
            vertices = scale * shape.vertices
            offsets = scale * shape.offsets
            return replace(
                shape, vertices=vertices, offsets=offsets, hull_volume=scale**3 * shape.volume
            )
    instead = "a cloud or a half-space for one of both"
    part = "its geometry into optional/curved/by_coal.py"
    raise shape.lacks("closest points with this solid", instead, part)


@lru_cache(maxsize=256)
def geometry(shape: Shape) -> coal.CollisionGeometry:
    """A shape as a collision geometry of coal; a box becomes a convex polytope.

    A `coal.Box` is 1e-10 larger, or not, by what its process asked coal before.

    Raises
    ------
    ModelError
        Of a mesh for whose edges coal has no place.
    """
    match shape:
        case Box():
            return _polytope(shape.corners(UP)[0], BOX_TRIANGLES)
        case Ellipsoid():
            return coal.Ellipsoid(shape.half_axes)
        case Revolved():
            kind = getattr(coal, type(shape).__name__)
            return kind(shape.radius, 2 * shape.half_length)
    assert isinstance(shape, ConvexMesh)
    if np.bincount(shape.triangles.ravel()).max() > MOST_NEIGHBOURS:
        problem = (
            f"has a corner with more than {MOST_NEIGHBOURS} edges, which distances to "
            "cylinders, cones and ellipsoids cannot have; take a coarser mesh"
        )
        raise ModelError(problem, field="convex mesh", value=shape.words())
    return _polytope(shape.vertices, shape.triangles)


def _polytope(vertices: Array, triangles: Indices) -> coal.CollisionGeometry:
    """A convex polytope, the corners of its triangles counter-clockwise from outside."""
    points = coal.StdVec_Vec3s()
    polygons = coal.StdVec_Triangle()
    points.extend(list(vertices))
    polygons.extend([coal.Triangle(*map(int, corners)) for corners in triangles])
    return coal.Convex(points, polygons)


def _best(a: ShapeInWorld, b: ShapeInWorld, start: Judged) -> Judged:
    """The widest proved gap among an answer and the local maxima near it."""
    if not np.isfinite(start.n).all():
        return start
    ways = [judged(a, b, *way) for way in settled(a, b, Witness(*start[:4]))]
    best = _widest([*ways, start], last=start)
    if best.proves_its_normal or best.phi < 0:
        return best
    # A corner or a tip near a rim: Newton's method has next to nothing to hold on to there.
    on_b = [judged(a, b, *way.swapped()) for way in _nearest_corner(b, a, -best.n)]
    on_a = [judged(a, b, *way) for way in _nearest_corner(a, b, best.n)]
    return _widest([best, *on_b, *on_a])


def _nearest_corner(solid: ShapeInWorld, other: ShapeInWorld, n: Array) -> list[Witness]:
    """The closest points of a solid and the nearest corner of another, n being out of the solid."""
    corners, radius = other.shape.corners(-n @ other.R)
    if not len(corners):
        return []
    points = corners @ other.R.T + other.t
    distance, normals = solid.shape.signed_distance((points - solid.t) @ solid.R)
    i = int(distance.argmin())
    out = solid.R @ normals[i]
    phi = float(distance[i])
    return [Witness(phi - radius, points[i] - phi * out, points[i] - radius * out, out)]


def _widest(every: list[Judged], last: Judged | None = None) -> Judged:
    """The widest gap that is proved, or what misses its proof by least.

    Of equal gaps `last` is taken if there is no other: coal's points lie on the solids to its
    tolerance alone, which a gap and a normal that are right to rounding do not show.
    """
    for tolerance in (ENOUGH, WITNESS):
        proved = [answer for answer in every if answer.defect <= tolerance]
        if proved:  # no gap exceeds the distance
            widest = max(answer.phi for answer in proved)
            level = [answer for answer in proved if answer.phi >= widest - tolerance]
            return min(level, key=lambda answer: (answer is last, answer.defect))
    return min(every, key=lambda answer: answer.defect)


def _by_coal(a: ShapeInWorld, b: ShapeInWorld) -> Judged:
    """The best of coal's answers, with its defect."""
    best: Judged | None = None
    for accuracy in ACCURACIES:
        request = coal.DistanceRequest()
        result = coal.DistanceResult()
        request.enable_signed_distance = True
        request.gjk_tolerance = request.epa_tolerance = accuracy
        request.gjk_max_iterations = request.epa_max_iterations = 1000
        phi = coal.distance(
            geometry(a.shape), coal.Transform3s(a.R, a.t),
            geometry(b.shape), coal.Transform3s(b.R, b.t),
            request, result,
        )  # fmt: skip
        alpha = np.array(result.getNearestPoint1())
        beta = np.array(result.getNearestPoint2())
        answer = judged(a, b, phi, alpha, beta, np.array(result.normal))
        if best is None or answer.defect < best.defect:
            best = answer
        if best.defect <= SUPPORT_DEFECT * np.abs(a.t - b.t).max():
            break
    assert best is not None
    return best


def judged(
    a: ShapeInWorld, b: ShapeInWorld, phi: float, alpha: Array, beta: Array, n: Array
) -> Judged:
    """An answer, with its defect: what phi n misses the gap along n and the points' distance by.

    Parameters
    ----------
    a, b : ShapeInWorld
    phi, alpha, beta, n : float, ndarray, ndarray, ndarray
        In whatever length unit the solids have.
    """
    if not (np.isfinite((phi, *alpha, *beta, *n)).all() and abs(n @ n - 1) <= WITNESS):
        return Judged(phi, alpha, beta, n, np.inf)
    gap = _gap(a, b, n)
    apart = np.abs(beta - alpha - phi * n).max()
    return Judged(phi, alpha, beta, n, float(max(abs(gap - phi), apart)))


def _gap(a: ShapeInWorld, b: ShapeInWorld, n: Array) -> float:
    """The gap s(n) from a to b along a unit vector."""
    return float(n @ (b.farthest(-n) - a.farthest(n)))


def _shallowest(a: ShapeInWorld, b: ShapeInWorld, first: Judged) -> Judged:
    """The least depth: coal's way out made exact, and every other that may be shorter."""
    n = first.n if np.isfinite(first.n).all() and first.n.any() else np.array([1.0, 0.0, 0.0])
    n = n / np.sqrt(n @ n)
    size = float(sum(solid.reach(np.stack([n, -n])).sum() for solid in (a, b)))
    known = _refined(a, b, n, size)
    best = max((first, known), key=lambda answer: (answer.defect <= WITNESS, answer.phi))
    rivals = rival_directions(a, b, best.n if best.defect <= WITNESS else n, best.phi, size)
    answers = [known, *(_refined(a, b, way, size) for way in rivals)]
    for answer in answers:
        if answer.defect <= WITNESS and answer.phi > best.phi:
            best = answer
    # No gap exceeds the signed distance: where one does, the way out was not found.
    if rivals and gaps(a, b, np.array(rivals)).max() > best.phi + WITNESS:
        return best._replace(defect=np.inf)
    # A way out that was not followed to its end, but may be the shorter one, decides nothing.
    open_ends = [way for way in answers[1:] if way.phi + way.defect > best.phi + WITNESS]
    if any(way.n @ best.n < SAME for way in open_ends):
        return best._replace(defect=np.inf)
    return best


def _refined(a: ShapeInWorld, b: ShapeInWorld, n: Array, size: float) -> Judged:
    """A maximum of the gap, followed from a direction.

    Parted along n by a little more than the depth, the solids have a distance and a normal that
    coal is good at; that normal is the next n, until the gap's own maximum is near.
    """
    best = Judged(-np.inf, a.t, b.t, n, np.inf)
    for k in range(ROUNDS):
        gap = _gap(a, b, n)
        # Round surfaces settle faster from afar, corners from close by: in turn.
        clearance = CLEARANCE * abs(gap) + (LEAST * size if k % 2 == 0 else 0.0)
        shift = (clearance - gap) * n
        parted = _by_coal(a, b._replace(t=b.t + shift))
        if not (np.isfinite(parted.defect) and parted.phi > 0):
            break
        before = n
        n = parted.n
        refined = _best(a, b, judged(a, b, _gap(a, b, n), parted.alpha, parted.beta - shift, n))
        if refined.defect < best.defect:
            best = refined
        if best.defect <= ENOUGH:
            break
        # A slow approach keeps its direction: take twice as long a step.
        n = n + (n - before)
        n = n / np.sqrt(n @ n)
    return best
