"""Which normal a contact has: the direction of the largest separation, and the rule for ties.

Where the normal of a pair of solids is one of several, the solids touch, and it is between them, or
the step is refused. A corner over a face that faces the pair's normal n has this face's normal, and
a corner on the edge or vertex that is farthest along n has n. A cloud need not be convex: its
points have their own faces, and of faces that are as near within rounding the one along which the
whole cloud is farthest out. docs/conventions.md states the rule, (R37) says why bodies that touch
bear along no other normal.
"""

from collections.abc import Callable
from typing import Final

import numpy as np

from quasistatic_ref.contact.outlines import grain, outlines
from quasistatic_ref.contact.shape_in_world import Pose, ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import pair_and_gaps
from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import dot, norm, product, total
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import HalfSpace, PointCloud, Shape, Sphere
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.shapes.shape import CHUNK
from quasistatic_ref.tolerances import FACING, SAME_NORMAL

TIED_FACES: Final = 1e-12
"""Difference of heights over two faces, or of the gaps along two normals, relative to sizes and
places, at which they count as equal [-]. Places are right to 1e-16, and a body that rests on
another stays where it is to about that."""

TOUCHING_FACES: Final = 1e-9
"""Depth relative to the same at which bodies that are as deep along two normals touch [-]: with one
between them. Deeper, the push-out along it would part them along neither."""

NEARLY_PARALLEL: Final = 40.0
"""Angle [rad] up to which tied normals have a mean however deep bodies are, over the square root of
what is rounding, relative to the smaller one's size: 4e-5 where all sizes are alike. A push-out
along that parts them along each. Gaps of equal bodies, turned by t, differ by some t^2 / 2 of their
size: they are tied where that is rounding."""

FAR_PLACES: Final = 1e3
"""Places relative to a solid's size [-] up to which their rounding, 1e-16 of them, is far below the
length to which distances are rounded, 1e-9 of the size. Beyond, a pair is seen from a point of it,
what is over a half-space from its foot there: corners and crossings then rank as the closest pair
does, and hold it in their hull."""

UNIQUE_NORMAL, OF_PAIR, BISECTOR, OF_CLOUD = range(4)
"""How a normal was chosen: no tie; as the pair's; between equal gaps of zero; as a cloud's."""

SAYS = {
    OF_PAIR: "another face is as near: the pair's normal",
    BISECTOR: "touches with two faces or edges at once: the normal between theirs",
    OF_CLOUD: "two faces are as near: the one along which the whole cloud is farthest out",
}
"""Each tie in words."""

TURNED = cos_sin(FACING)[0]
"""Least cosine of the angle between the pair's normal and that of a face or corner that bears."""


Surface = tuple[Array, Array, Indices]
"""What N points have on a solid, in its frame: phi, (N,) [m]; the normal, (N, 3) [-]; and how that
was chosen, (N,)."""

KnownGaps = Callable[[ShapeInWorld, ShapeInWorld, Witness], tuple[Array, Array]]
"""Two solids and their closest points -> gaps, (N,) [m], along normals, (N, 3) [-]."""


def rounding(solid: ShapeInWorld, other: ShapeInWorld) -> float:
    """The largest difference [m] of two heights that rounding can cause."""
    here = float(max(np.abs(solid.t).max(), np.abs(other.t).max()))
    places = max(here, solid.away, other.away)
    extents = [s.shape.extent for s in (solid, other) if not isinstance(s.shape, PointCloud)]
    return TIED_FACES * max([places, *(x for x in extents if np.isfinite(x))])


def pair_normal(
    name: str, a: ShapeInWorld, b: ShapeInWorld, may_raise_k: bool = True
) -> tuple[Witness, int]:
    """Closest points of two solids with the normal by the rule, and how the rule chose it.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    a, b : ShapeInWorld
    may_raise_k : bool
        Whether the pair has more candidates than contacts.

    Raises
    ------
    ContactError
        If the solids are as deep in each other along two normals, or have no trustworthy one.
    """
    within = rounding(a, b)
    nearest, every = pair_and_gaps(name, a, b, within)
    normals = tied_normals(a, b, nearest, within, every)
    if len(normals) == 1:
        return nearest, UNIQUE_NORMAL
    size = min(a.shape.extent, b.shape.extent)
    of_pair = size, grain(a.shape, b.shape), may_raise_k
    refuse_unless_touching(name, nearest.phi, normals, within, *of_pair)
    n = mean_direction(normals)
    phi = float(gaps(a._replace(t=a.t - b.t), b._replace(t=0 * b.t), n[None])[0])
    return Witness(phi, nearest.alpha, nearest.alpha + phi * n, n), BISECTOR


def tied_normals(
    a: ShapeInWorld,
    b: ShapeInWorld,
    nearest: Witness,
    within: float,
    every: tuple[Array, Array] | None,
) -> Array:
    """All normals of two solids along which their gap is the signed distance, shape (T, 3).

    Parameters
    ----------
    a, b : ShapeInWorld
    nearest : Witness
        Their closest points.
    within : float
        Largest difference of gaps that are equal [m].
    every : (ndarray, ndarray) or None
        Of two polytopes, all gaps (N,) [m] and normals (N, 3) [-].
    """
    shapes = (a.shape, b.shape)
    normal = nearest.n[None]
    cores_apart = nearest.phi + sum(s.core[1] for s in shapes if isinstance(s, Rounded))
    if cores_apart > within or any(isinstance(shape, HalfSpace) for shape in shapes):
        return normal
    if any(isinstance(shape, Sphere) for shape in shapes):
        gaps_along, normals = _of_centre(a, b, nearest)
    else:
        if every is None:
            # Gaps along what may be normals, and these.
            known_gaps: KnownGaps = part("known_gaps")
            every = known_gaps(a, b, nearest)
        gaps_along, normals = every
    tied = distinct([*normals[gaps_along >= nearest.phi - within]])
    if len(tied) > 1:
        return tied
    return distinct([nearest.n, *tied])


def _of_centre(a: ShapeInWorld, b: ShapeInWorld, nearest: Witness) -> tuple[Array, Array]:
    """Gaps of a sphere over each face of a solid."""
    solid, ball, sign = (a, b, 1.0) if isinstance(b.shape, Sphere) else (b, a, -1.0)
    assert isinstance(ball.shape, Sphere)
    heights, normals = solid.shape.faces(product(ball.t - solid.t, solid.R)[None])
    return heights[0] - ball.shape.radius, sign * product(normals[0], solid.R.T)


def gaps(a: ShapeInWorld, b: ShapeInWorld, directions: Array) -> Array:
    """Gap from a to b along unit vectors (N, 3) of the world frame, shape (N,) [m]."""
    return -b.reach(-directions) - a.reach(directions)


def distinct(normals: list[Array]) -> Array:
    """Unit vectors `normals` (3,) [-], each once, shape (T, 3)."""
    kept: list[Array] = []
    for normal in normals:
        if all(np.abs(normal - other).max() > SAME_NORMAL for other in kept):
            kept.append(normal)
    return np.array(kept)


def mean_direction(normals: Array) -> Array:
    """The unit vector along the mean of `normals`, shape (T, 3) [-]."""
    mean = total(normals)
    return np.asarray(mean / norm(mean))


def refuse_unless_touching(
    name: str,
    phi: float,
    normals: Array,
    within: float,
    size: float,
    grain: float,
    may_raise_k: bool,
) -> None:
    """Refuse bodies that are as deep in each other along several normals, or along opposite ones.

    Parameters
    ----------
    name : str
        Of the pair.
    phi : float
    normals : ndarray, shape (T, 3)
        In the world frame [-].
    within : float
        What is rounding, TIED_FACES of the sizes and places [m].
    size, grain : float
        Of the smaller body and of the pair [m].
    may_raise_k : bool
        Whether the pair has more candidates than contacts.

    Raises
    ------
    ContactError
        If phi is not about zero and the normals are not nearly parallel, or if they have no mean: a
        body is thinner than rounding.
    """
    apart = norm(normals[:, None] - normals).max()
    if apart < min(NEARLY_PARALLEL * np.sqrt(within / size), FACING):
        return
    mean = total(normals)
    opposite = dot(mean, mean) < SAME_NORMAL
    if opposite or phi < -max(TOUCHING_FACES / TIED_FACES * within, grain):
        one, other = (
            np.array2string(normal + 0.0, precision=4, separator=", ") for normal in normals[:2]
        )
        remedy = "start them apart, or less deep along one of the two"
        if dot(normals[0], normals[1]) >= np.cos(FACING):
            remedy = "start them apart"
            table = f"contacts.{name.partition('(')[0]}"
            if may_raise_k:
                remedy = (
                    f"raise k of {table}: a face that lies on another turns into it where fewer "
                    f"contacts are kept than it has corners; at the start, {remedy}"
                )
        raise ContactError(
            f"the bodies are as deep in each other along {one} as along {other}, {-phi:.3g} m: "
            f"the normal is not defined; {remedy}",
            field=name,
        )


def faces_apart(heights: Array, normals: Array, within: float | Array) -> tuple[Indices, Mask]:
    """The highest face of each point, and all faces as high that have another normal.

    Parameters
    ----------
    heights : ndarray, shape (N, F)
        As of :meth:`~quasistatic_ref.shapes.shape.Shape.faces`, F > 0 [m].
    normals : ndarray, shape (N, F, 3)
        [-].
    within : float or ndarray, shape (N,)
        Largest difference of heights that are equal [m].

    Returns
    -------
    highest : ndarray of int, shape (N,)
    rivals : ndarray of bool, shape (N, F)
    """
    every = np.arange(len(heights))
    highest = heights.argmax(axis=1)
    rivals = heights >= (heights[every, highest] - within)[:, None]
    point, face = rivals.nonzero()
    away = np.abs(normals[point, face] - normals[point, highest[point]]).max(axis=1)
    rivals[point, face] = away > SAME_NORMAL
    return highest, rivals


def corner_surface(
    shape: Shape, x: Array, n: Array, within: float | Array, near: float | Array
) -> Surface:
    """Distances and normals of another solid's corners on a solid.

    Parameters
    ----------
    shape : Shape
    x : ndarray, shape (N, 3)
        In its frame [m].
    n : ndarray, shape (3,) or (N, 3)
        The pair's normal out of the solid, in its frame [-].
    within, near : float or ndarray, shape (N,)
        What is rounding, and how far above a face a corner is over it [m].
    """
    phi, normal = shape.signed_distance(x)
    tie = np.full(len(x), UNIQUE_NORMAL)
    if isinstance(shape, HalfSpace):
        return phi, normal, tie
    # Another corner is outside, and nearest to a face that faces n: nothing else to choose.
    within = within + np.zeros(len(x))
    near = near + np.zeros(len(x))
    undecided = np.flatnonzero((phi <= near) | (dot(normal, n) < TURNED))
    reach = shape.support_value(np.atleast_2d(n)) + np.zeros(len(x))
    n = np.broadcast_to(n, x.shape)
    phi = phi.copy()
    before = normal
    normal = normal.copy()
    block = max(1, CHUNK // max(1, shape.at_points(slice(1)).faces(x[:1])[0].size))
    for start in range(0, len(undecided), block):
        some = undecided[start : start + block]
        over, height, facing = _facing(
            shape.at_points(some), x[some], n[some], within[some], near[some]
        )
        phi[some[over]] = height
        normal[some[over]] = facing
        edge = np.delete(some, over)
        gap = dot(x[edge], n[edge]) - reach[edge]
        on_edge = _over(shape.at_points(edge), x[edge], gap, n[edge], near[edge])
        phi[edge[on_edge]] = gap[on_edge]
        normal[edge[on_edge]] = n[edge[on_edge]]
    tie[dot(before, normal) < 1 - SAME_NORMAL] = OF_PAIR
    return phi, normal, tie


def _facing(
    shape: Shape, x: Array, n: Array, within: Array, near: Array
) -> tuple[Indices, Array, Array]:
    """Numbers of points over a face that faces n, and their heights and normals there."""
    heights, normals = shape.faces(x)
    if isinstance(shape, ConvexMesh):
        normals = np.broadcast_to(outlines(shape).normals, normals.shape)
    if not heights.size:
        return np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 3))
    heights = np.where(dot(normals, n[:, None]) >= TURNED, heights, -np.inf)
    highest = heights.max(axis=1)
    low = np.flatnonzero(np.isfinite(highest) & (highest <= near))
    face, rivals = faces_apart(heights[low], normals[low], within[low])
    height = highest[low]
    facing = normals[low, face]
    over = _over(shape.at_points(low), x[low], height, facing, near[low]) & ~rivals.any(axis=1)
    return low[over], height[over], facing[over]


def _over(shape: Shape, x: Array, height: Array, normal: Array, near: Array) -> Mask:
    """Mask of points at most at a plane's height whose feet on the plane lie on the shape."""
    over = (height <= near) & np.isfinite(height)
    if over.any():
        foot = x[over] - height[over, None] * normal[over]
        over[over] = shape.at_points(over).signed_distance(foot)[0] <= near[over]
    return over


def cloud_surface(
    name: str,
    solid: ShapeInWorld,
    cloud: ShapeInWorld,
    relative: Pose,
    x: Array,
    phi: Array,
    normal: Array,
) -> Surface:
    """Distances and normals of a cloud's points on a solid, where several faces may tie.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    solid, cloud : ShapeInWorld
    relative : Pose
        Of the cloud's frame in the solid's.
    x : ndarray, shape (k, 3)
        Some of its points, in the solid's frame [m].
    phi : ndarray, shape (k,)
        Their signed distances [m].
    normal : ndarray, shape (k, 3)
        The normals that these have.

    Raises
    ------
    ContactError
        If the cloud is as deep along two of the normals that a point has.
    """
    tie = np.full(len(x), UNIQUE_NORMAL)
    within = rounding(solid, cloud)
    near = np.flatnonzero(phi <= within)
    if not near.size:
        return phi, normal, tie
    heights, normals = solid.shape.faces(x[near])
    if not heights.size:
        return phi, normal, tie
    highest, rivals = faces_apart(heights, normals, within)
    undecided = np.flatnonzero(rivals.any(axis=1))
    if not len(undecided):
        return phi, normal, tie
    normal = normal.copy()
    decided: dict[bytes, tuple[Array, int]] = {}
    assert isinstance(cloud.shape, PointCloud)
    more = len(x) < len(cloud.shape.points)
    for i in undecided.tolist():
        ways = distinct([normals[i, highest[i]], *normals[i, rivals[i]]])
        if ways.tobytes() not in decided:
            decided[ways.tobytes()] = _of_cloud(name, solid, cloud, relative, ways, within, more)
        normal[near[i]], tie[near[i]] = decided[ways.tobytes()]
    return phi, normal, tie


def _of_cloud(
    name: str,
    solid: ShapeInWorld,
    cloud: ShapeInWorld,
    relative: Pose,
    ways: Array,
    within: float,
    may_raise_k: bool,
) -> tuple[Array, int]:
    """The one of several normals along which a cloud is farthest out."""
    assert isinstance(cloud.shape, PointCloud)
    points = relative.points(cloud.shape.points)
    out = np.array([dot(points, way).min() for way in ways]) - solid.shape.support_value(ways)
    level = out >= out.max() - within
    if np.count_nonzero(level) == 1:
        return ways[level][0], OF_CLOUD
    normals = product(ways[level], solid.R.T)
    refuse_unless_touching(name, out.max(), normals, within, solid.shape.extent, 0.0, may_raise_k)
    return mean_direction(ways[level]), BISECTOR
