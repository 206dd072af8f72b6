"""The two sides of each contact of a step: whose points they are, and what the shapes are there."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints, in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.optional.derivatives.contact.features import Feature, ball, feature
from quasistatic_ref.shapes.placed_shape import Cylinder, PointCloud, Sphere
from quasistatic_ref.shapes.round import QUARTERS
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import LEVEL, ON_RIM

Z = np.array([0.0, 0.0, 1.0])


class Rim(NamedTuple):
    """A corner that is no material point: one of four on a rim, the first towards the other body.

    Parameters
    ----------
    side : int
        0 of alpha's body, 1 of beta's.
    quarter : int
        How many quarter turns it is from the first.
    radius : float
        Of the rim [m].
    """

    side: int
    quarter: int
    radius: float


class Couple(NamedTuple):
    """One contact as two features.

    Parameters
    ----------
    pair : ContactPair
    bodies : (ShapeInWorld, ShapeInWorld)
        alpha's and beta's shape in the world.
    phi : float
    points : (ndarray, ndarray), each of shape (3,)
        Closest points on both [m], world frame.
    n : ndarray, shape (3,)
        Normal from alpha's body to beta's.
    features : (Feature, Feature)
        In the world frame.
    centre : (int, ndarray, float) or None
        Where one side is a point with a ball about it: the other side, the point (3,) [m] in the
        world and the ball's radius [m].
    rim : Rim or None
    crosses : bool
        Whether the points are where edges cross.
    extents : (float, float)
        How large the bodies are [m]; of a half-space, infinity.
    """

    pair: ContactPair
    bodies: tuple[ShapeInWorld, ShapeInWorld]
    phi: float
    points: tuple[Array, Array]
    n: Array
    features: tuple[Feature, Feature]
    centre: tuple[int, Array, float] | None
    rim: Rim | None
    crosses: bool
    extents: tuple[float, float]

    @property
    def size(self) -> float:
        """The larger extent [m]; a half-space has none, and a single point one metre."""
        return max(extent for extent in self.extents if np.isfinite(extent)) or 1.0

    @property
    def reach(self) -> float:
        """The size, or a point's largest coordinate [m]: places are rounded to a share of it."""
        return max(self.size, *(float(np.abs(point).max()) for point in self.points))


def couples(
    pairs: Sequence[ContactPair], points: ClosestPoints, R: Array, t: Array
) -> list[Couple]:
    """The contacts of all pairs at their closest points; R (L, 3, 3), t (L, 3) are the links'."""
    found, at = [], 0
    for pair in pairs:
        a = in_world(pair.alpha, R, t)
        b = in_world(pair.beta, R, t)
        sizes = _extents(a, b)
        for j in range(at, at + pair.n_c):
            found.append(_couple(pair, a, b, points.chosen(np.array([j])), sizes))
        at += pair.n_c
    return found


def closest_pair(
    pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld, points: ClosestPoints
) -> Couple:
    """The closest pair of two solids as a couple; `points` has one, `a` and `b` are the bodies."""
    return _couple(pair, a, b, points._replace(point=np.array([pair.corners])), _extents(a, b))


def _extents(a: ShapeInWorld, b: ShapeInWorld) -> tuple[float, float]:
    """How large two bodies are [m]: a cloud as the box about it; of a half-space, infinity."""
    first, second = (
        float(np.ptp(body.shape.points, axis=0).max())
        if isinstance(body.shape, PointCloud)
        else body.shape.extent
        for body in (a, b)
    )
    return first, second


def _couple(
    pair: ContactPair,
    a: ShapeInWorld,
    b: ShapeInWorld,
    one: ClosestPoints,
    extents: tuple[float, float],
) -> Couple:
    phi, n, index = float(one.phi[0]), one.n[0], int(one.point[0])
    ends = one.alpha[0], one.beta[0]
    corner = _corner(pair, a, b, index)
    features, centre, rim = [], None, None
    for side, (body, end, outward) in enumerate(((a, ends[0], n), (b, ends[1], -n))):
        own = corner if corner is not None and corner[0] == side else None
        if own is not None:
            features.append(ball(own[1], outward))
            centre, rim = (1 - side, end - own[1] * outward, own[1]), own[2]
            continue
        local = feature(body.shape, body.R.T @ (end - body.t), body.R.T @ outward)
        features.append(local.turned(body.R))
        if isinstance(body.shape, Sphere):
            centre = (1 - side, body.t, body.shape.radius)
    crosses = not pair.has_cloud and index >= pair.corners + pair.n_c > pair.corners + 1
    both = features[0], features[1]
    return Couple(pair, (a, b), phi, ends, n, both, centre, rim, crosses, extents)


def _corner(
    pair: ContactPair, a: ShapeInWorld, b: ShapeInWorld, index: int
) -> tuple[int, float, Rim | None] | None:
    """Which side is a corner, the ball about it and its rim; None of a closest pair."""
    for side, body in enumerate((a, b)):
        if isinstance(body.shape, PointCloud):
            return side, 0.0, None
    if pair.n_c == 1 or index >= pair.corners:
        return None
    first = a.shape.corner_count
    side, k = (0, index) if index < first else (1, index - first)
    shape = (a, b)[side].shape
    before = shape.corner_count % 4  # its rims come last, with four corners each
    if shape.rim_radius is not None and k >= before:
        return side, 0.0, Rim(side, (k - before) % 4, shape.rim_radius)
    return side, shape.corners(Z)[1], None


def rim_velocity(rim: Rim, body: ShapeInWorld, towards: Array, turning: Array) -> Array | None:
    """How a corner on a rim moves on its body, shape (3, n_v) [m], world frame.

    Parameters
    ----------
    rim : Rim
    body : ShapeInWorld
    towards : ndarray, shape (3,)
        Unit vector [-] from this body to the other, world frame.
    turning : ndarray, shape (3, n_v)
        Its derivatives as seen from the body [-].

    Returns
    -------
    ndarray or None
        None where the rim is level but does not stay so: no point of it is the nearest, or float64
        does not know which.
    """
    own, d_own = (body.R.T @ towards)[:2], (body.R.T @ turning)[:2]
    length = np.hypot(*own)
    first = Cylinder(1.0, 1.0).corners(np.array([*own, 0.0]))[0][0, :2]
    if length <= LEVEL:
        return None if np.abs(d_own).max(initial=0.0) > ON_RIM else np.zeros_like(turning)
    d_first = (d_own - np.outer(first, first @ d_own)) / length
    c, s = QUARTERS[rim.quarter]
    # The quarter's point is c u + s (-u_y, u_x).
    turned = np.stack([c * d_first[0] - s * d_first[1], c * d_first[1] + s * d_first[0]])
    return np.asarray(rim.radius * body.R[:, :2] @ turned)
