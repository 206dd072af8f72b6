"""The two sides of each contact of a step: whose points they are, and what the shapes are there."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints, Search, in_world, search
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.contact.features import Feature, ball, feature
from quasistatic_ref.optional.derivatives.tolerances import LEVEL
from quasistatic_ref.shapes.placed_shape import PointCloud, Sphere
from quasistatic_ref.shapes.revolved import rim_corners
from quasistatic_ref.tolerances import ON_RIM

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


@dataclass(frozen=True, eq=False)
class PairInWorld:
    """A pair at one configuration, which is searched when that is first read.

    Parameters
    ----------
    pair : ContactPair
    bodies : (ShapeInWorld, ShapeInWorld)
        alpha's and beta's shape in the world.
    """

    pair: ContactPair
    bodies: tuple[ShapeInWorld, ShapeInWorld]

    @cached_property
    def extents(self) -> tuple[float, float]:
        """How large the bodies are [m]; of a half-space, infinity."""
        first, second = self.bodies
        return first.shape.extent, second.shape.extent

    @cached_property
    def size(self) -> float:
        """The larger extent [m]; a half-space has none, and a single point one metre."""
        return max(extent for extent in self.extents if np.isfinite(extent)) or 1.0

    @cached_property
    def search(self) -> Search:
        """What its contacts are chosen from."""
        return search(self.pair, *self.bodies)

    @cached_property
    def closest(self) -> "Couple":
        """The closest pair of two solids, of which several contacts are kept, as a couple."""
        return _couple(self, self.search.nearest, 0)


class Couple(NamedTuple):
    """One contact as two features.

    Parameters
    ----------
    of : PairInWorld
    phi : float
    points : (ndarray, ndarray), each of shape (3,)
        Closest points on both [m], world frame.
    n : ndarray, shape (3,)
        Normal from alpha's body to beta's.
    features : (Feature, Feature)
        In the world frame.
    centre : (int, ndarray) or None
        Where one side is a point with a ball about it: the other side, and the point (3,) [m] in
        the world.
    rim : Rim or None
    crosses : bool
        Whether the points are where edges cross.
    """

    of: PairInWorld
    phi: float
    points: tuple[Array, Array]
    n: Array
    features: tuple[Feature, Feature]
    centre: tuple[int, Array] | None
    rim: Rim | None
    crosses: bool

    @property
    def reach(self) -> float:
        """The size, or a point's largest coordinate [m]: places are rounded to a share of it."""
        return max(self.of.size, *(float(np.abs(point).max()) for point in self.points))

    @property
    def at_an_end(self) -> bool:
        """Whether a feature ends here."""
        return any(len(f.ends) for f in self.features)

    @property
    def merged(self) -> "Couple":
        """The same with the directions in which its features end as free ones."""
        first, second = (f.merged for f in self.features)
        return self._replace(features=(first, second))


def couples(
    pairs: Sequence[ContactPair], points: ClosestPoints, R: Array, t: Array
) -> list[Couple]:
    """The contacts of all pairs at their closest points; R (L, 3, 3), t (L, 3) are the links'."""
    contacts = list[Couple]()
    for pair in pairs:
        of = PairInWorld(pair, in_world(pair, R, t))
        at = len(contacts)
        contacts += [_couple(of, points, j) for j in range(at, at + pair.n_c)]
    return contacts


def _couple(of: PairInWorld, points: ClosestPoints, j: int) -> Couple:
    phi = float(points.phi[j])
    n = points.n[j]
    index = int(points.point[j])
    ends = (points.alpha[j], points.beta[j])
    pair = of.pair
    corner, radius, rim = _corner(of, index)
    features = []
    centre = None
    for side, (body, end, outward) in enumerate(zip(of.bodies, ends, (n, -n), strict=True)):
        if side == corner:
            features.append(ball(radius, outward))
            centre = (1 - side, end - radius * outward)
            continue
        local = feature(body.shape, body.R.T @ (end - body.t), body.R.T @ outward)
        features.append(local.turned(body.R))
        if isinstance(body.shape, Sphere):
            centre = (1 - side, body.t)
    crosses = not pair.has_cloud and index >= pair.corners + pair.n_c
    return Couple(of, phi, ends, n, (features[0], features[1]), centre, rim, crosses)


def _corner(of: PairInWorld, index: int) -> tuple[int | None, float, Rim | None]:
    """Which side is a corner, the ball about it and its rim; of a closest pair neither side is."""
    for side, body in enumerate(of.bodies):
        if isinstance(body.shape, PointCloud):
            return side, 0.0, None
    if of.pair.n_c == 1 or index >= of.pair.corners:
        return None, 0.0, None
    first = of.bodies[0].shape.corner_count
    side, k = (0, index) if index < first else (1, index - first)
    shape = of.bodies[side].shape
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
    local = body.R.T @ towards
    d_local = (body.R.T @ turning)[:2]
    length = np.hypot(*local[:2])
    if length <= LEVEL:
        return None if np.abs(d_local).max(initial=0.0) > ON_RIM else np.zeros_like(turning)
    around = rim_corners(1.0, 0.0, local)
    turn = around[1, :2] @ d_local / length
    # Each corner moves towards the next one.
    return np.outer(rim.radius * body.R @ around[(rim.quarter + 1) % 4], turn)
