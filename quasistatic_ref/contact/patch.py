"""Which normal a contact has where a point is as near to one face as to another.

Of two convex solids it is the pair's, the direction n of the largest gap s(n): a corner over a face
that faces n has this face's normal, and a corner on the edge or vertex that is farthest along n
has n. A cloud need not be convex: its points have their own faces, and of faces that are as near
within rounding the one along which the whole cloud is farthest out. docs/conventions.md states the
rule, (R36) says why no other candidate of a pair can bear.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.cloud import signed_distance
from quasistatic_ref.contact.placed import Placed, Witness
from quasistatic_ref.contact.poses import rotated
from quasistatic_ref.contact.solids.solid_pair import pair_and_gaps
from quasistatic_ref.contact.solids.ways_out import gaps, sharp_directions
from quasistatic_ref.errors import ContactError
from quasistatic_ref.shapes.hull import CHUNK, dot
from quasistatic_ref.shapes.placed_shape import Capsule, HalfSpace, PointCloud, Shape, Sphere
from quasistatic_ref.step.data import Array, Indices, Mask
from quasistatic_ref.tolerances import (
    FACING,
    OVER_FACE,
    SAME_NORMAL,
    TIED_FACES,
    TOUCHING_FACES,
)

OWN, OF_PAIR, BISECTOR, OF_CLOUD = range(4)
"""How a normal was chosen: no tie; as the pair's; between equal gaps of zero; as a cloud's."""

SAYS = {
    OF_PAIR: "another face is as near: the pair's normal",
    BISECTOR: "touches with two faces or edges at once: the normal between theirs",
    OF_CLOUD: "two faces are as near: the one along which the whole cloud is farthest out",
}
"""Each tie in words."""

TURNED = float(np.cos(FACING))


class Surface(NamedTuple):
    """What points have on a solid, in its frame.

    Parameters
    ----------
    phi : ndarray, shape (N,)
        [m].
    normal : ndarray, shape (N, 3)
        [-].
    tie : ndarray of int, shape (N,)
        How the normal was chosen.
    """

    phi: Array
    normal: Array
    tie: Indices


def rounding(solid: Placed, other: Placed) -> float:
    """Difference of two heights over a solid that is rounding [m]: of sizes and of places."""
    places = float(max(np.abs(solid.t).max(), np.abs(other.t).max()))
    extents = [s.shape.extent for s in (solid, other) if not isinstance(s.shape, PointCloud)]
    return TIED_FACES * max([places, *(x for x in extents if np.isfinite(x))])


def faces_apart(heights: Array, normals: Array, within: float) -> tuple[Indices, Mask]:
    """The highest face of each point, and those of another normal that are as high.

    Parameters
    ----------
    heights : ndarray, shape (N, F)
        As of :meth:`~quasistatic_ref.shapes.shape.Shape.faces`, F > 0 [m].
    normals : ndarray, shape (N, F, 3)
        [-].
    within : float
        Largest difference of heights that are equal [m].

    Returns
    -------
    highest : ndarray of int, shape (N,)
    rivals : ndarray of bool, shape (N, F)
    """
    every, highest = np.arange(len(heights)), heights.argmax(axis=1)
    level = heights >= (heights[every, highest] - within)[:, None]
    away = np.abs(normals - normals[every, highest][:, None]).max(axis=2)
    return highest, level & (away > SAME_NORMAL)


def corner_surface(solid: Placed, x: Array, n: Array, within: float) -> Surface:
    """What corners of another solid have on a solid.

    Parameters
    ----------
    solid : Placed
    x : ndarray, shape (N, 3)
        In its frame [m].
    n : ndarray, shape (3,)
        The pair's normal out of the solid, in its frame [-].
    within : float
        What is rounding [m].
    """
    shape = solid.shape
    phi, normal = signed_distance(shape, x)
    tie = np.full(len(x), OWN)
    if isinstance(shape, HalfSpace):
        return Surface(phi, normal, tie)
    # Another corner is outside, and nearest to a face that faces n: nothing else to choose.
    near = OVER_FACE * shape.extent + within
    open_ = np.flatnonzero((phi <= near) | (normal @ n < TURNED))
    phi, own, normal = phi.copy(), normal, normal.copy()
    block = max(1, CHUNK // max(1, shape.faces(x[:1])[0].size))
    for start in range(0, len(open_), block):
        some = open_[start : start + block]
        over, phi[some], normal[some] = _facing(shape, x[some], n, phi[some], normal[some], within)
        edge = some[~over]
        gap = x[edge] @ n - shape.support_value(n[None])
        on_edge = _over(shape, x[edge], gap, np.broadcast_to(n, (len(edge), 3)), near)
        phi[edge[on_edge]], normal[edge[on_edge]] = gap[on_edge], n
    tie[np.sum(own * normal, axis=1) < 1 - SAME_NORMAL] = OF_PAIR
    return Surface(phi, normal, tie)


def _facing(
    shape: Shape, x: Array, n: Array, phi: Array, normal: Array, within: float
) -> tuple[Mask, Array, Array]:
    """Which points are over a face that faces n, and what they have then; others as they were."""
    heights, normals = shape.faces(x)
    if not heights.size:
        return np.zeros(len(x), dtype=bool), phi, normal
    heights = np.where(normals @ n >= TURNED, heights, -np.inf)
    face, rivals = faces_apart(heights, normals, within)
    chosen = np.arange(len(x)), face
    height, own = heights[chosen], normals[chosen]
    over = _over(shape, x, height, own, OVER_FACE * shape.extent + within) & ~rivals.any(axis=1)
    return over, np.where(over, height, phi), np.where(over[:, None], own, normal)


def _over(shape: Shape, x: Array, height: Array, normal: Array, near: float) -> Mask:
    """Whether points are not above a plane, and their feet on it are on the shape."""
    over = (height <= near) & np.isfinite(height)
    if over.any():
        foot = x[over] - height[over, None] * normal[over]
        over[over] = shape.signed_distance(foot)[0] <= near
    return over


def cloud_surface(
    name: str, solid: Placed, cloud: Placed, relative: Array, x: Array, phi: Array, normal: Array
) -> Surface:
    """What points of a cloud have on a solid.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    solid, cloud : Placed
    relative : ndarray, shape (3, 4)
        [R, t] from the cloud's frame to the solid's.
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
    tie, within = np.full(len(x), OWN), rounding(solid, cloud)
    near = np.flatnonzero(phi <= within)
    heights, normals = solid.shape.faces(x[near])
    if not heights.size:
        return Surface(phi, normal, tie)
    highest, rivals = faces_apart(heights, normals, within)
    open_ = np.flatnonzero(rivals.any(axis=1))
    if not len(open_):
        return Surface(phi, normal, tie)
    normal = normal.copy()
    decided: dict[bytes, tuple[Array, int]] = {}
    for i in open_.tolist():
        ways = distinct([normals[i, highest[i]], *normals[i, rivals[i]]])
        if ways.tobytes() not in decided:
            decided[ways.tobytes()] = _of_cloud(name, solid, cloud, relative, ways, within)
        normal[near[i]], tie[near[i]] = decided[ways.tobytes()]
    return Surface(phi, normal, tie)


def _of_cloud(
    name: str, solid: Placed, cloud: Placed, relative: Array, ways: Array, within: float
) -> tuple[Array, int]:
    """The one of several normals along which a cloud is farthest out."""
    assert isinstance(cloud.shape, PointCloud)
    points = rotated(relative[:, :3], cloud.shape.points) + relative[:, 3]
    out = np.array([dot(points, way).min() for way in ways]) - solid.shape.support_value(ways)
    level = out >= out.max() - within
    if np.count_nonzero(level) == 1:
        return ways[level][0], OF_CLOUD
    refuse_unless_touching(name, out.max(), ways[level] @ solid.R.T, within)
    return mean_direction(ways[level]), BISECTOR


def pair_normal(name: str, a: Placed, b: Placed) -> tuple[Witness, int]:
    """Closest points of two solids with the normal that the rule gives, and how it was chosen.

    Parameters
    ----------
    name : str
        Of the pair, for messages.
    a, b : Placed

    Raises
    ------
    ContactError
        If the solids are as deep in each other along two normals, or have no trustworthy one.
    """
    (found, every), within = pair_and_gaps(name, a, b), rounding(a, b)
    ways = tied_normals(a, b, found, within, every)
    if len(ways) == 1:
        return found, OWN
    refuse_unless_touching(name, found.phi, ways, within)
    n = mean_direction(ways)
    phi = float(gaps(a._replace(t=a.t - b.t), b._replace(t=0 * b.t), n[None])[0])
    return Witness(phi, found.alpha, found.alpha + phi * n, n), BISECTOR


def tied_normals(
    a: Placed,
    b: Placed,
    found: Witness,
    within: float,
    every: tuple[Array, Array] | None = None,
) -> Array:
    """All normals of two solids along which their gap is the signed distance, shape (T, 3).

    Parameters
    ----------
    a, b : Placed
    found : Witness
        Their closest points, whose normal comes first.
    within : float
        Largest difference of gaps that are equal [m].
    every : (ndarray, ndarray), optional
        Of two polytopes, all gaps and normals.
    """
    shapes, own = (a.shape, b.shape), found.n[None]
    if found.phi > within or any(isinstance(shape, HalfSpace) for shape in shapes):
        return own
    if any(isinstance(shape, Sphere) for shape in shapes):
        out, ways = _of_centre(a, b, found)
    elif all(isinstance(shape, Capsule) for shape in shapes):
        radii = sum(shape.radius for shape in shapes if isinstance(shape, Capsule))
        out, ways = np.array([-found.phi - 2 * radii]), -own
    else:
        out, ways = _of_solids(a, b, found) if every is None else every
    tied = distinct([*ways[out >= found.phi - within]])
    if len(tied) > 1:
        return tied
    return distinct([found.n, *tied])


def _of_centre(a: Placed, b: Placed, found: Witness) -> tuple[Array, Array]:
    """Of a sphere and a solid: heights of its centre over the faces, less the radius."""
    solid, ball, sign = (a, b, 1.0) if isinstance(b.shape, Sphere) else (b, a, -1.0)
    assert isinstance(ball.shape, Sphere)
    heights, normals = solid.shape.faces(((ball.t - solid.t) @ solid.R)[None])
    return heights[0] - ball.shape.radius, sign * normals[0] @ solid.R.T


def _of_solids(a: Placed, b: Placed, found: Witness) -> tuple[Array, Array]:
    """Along the normals of the faces at the closest points, and along the axes."""
    ways = [sharp_directions(a), -sharp_directions(b)]
    for solid, end, sign in ((a, found.alpha, 1.0), (b, found.beta, -1.0)):
        _, normals = solid.shape.faces(((end - solid.t) @ solid.R)[None])
        ways.append(sign * normals[0] @ solid.R.T)
    every = np.concatenate(ways)
    return gaps(a._replace(t=a.t - b.t), b._replace(t=0 * b.t), every), every


def distinct(ways: list[Array]) -> Array:
    """Unit vectors without those that are an earlier one again, shape (T, 3)."""
    found: list[Array] = []
    for way in ways:
        if all(np.abs(way - other).max() > SAME_NORMAL for other in found):
            found.append(way)
    return np.array(found)


def mean_direction(ways: Array) -> Array:
    """The unit vector of the mean of some, (T, 3): of two, their bisector."""
    mean = ways.sum(axis=0)
    return np.asarray(mean / np.sqrt(mean @ mean))


def refuse_unless_touching(name: str, phi: float, ways: Array, within: float) -> None:
    """Raise ContactError where bodies are in each other, as deep along the one way as the other."""
    if phi < -TOUCHING_FACES / TIED_FACES * within:
        one, other = (np.array2string(way + 0.0, precision=4, separator=", ") for way in ways[:2])
        raise ContactError(
            f"the bodies are as deep in each other along {one} as along {other}, {-phi:.3g} m: "
            "no normal is right; start them less deep along one of the two",
            field=name,
        )
