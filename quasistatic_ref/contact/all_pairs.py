"""The closest points of a list of pairs: pairs of one kind at once, all others one by one."""

from collections import defaultdict
from collections.abc import Hashable, Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.batches.balls import OnHalfSpaces, Spheres
from quasistatic_ref.contact.batches.batch import Batch
from quasistatic_ref.contact.batches.clouds import Clouds
from quasistatic_ref.contact.batches.rounded_boxes import RoundedBoxes
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.outlines import bearing_corners
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import all_finite
from quasistatic_ref.numbers.compiled import is_compiled
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    HalfSpace,
    PointCloud,
    Shape,
    Sphere,
)
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.shapes.shape import CHUNK, DIRECTIONS
from quasistatic_ref.tolerances import REPEATED

Kind = tuple[type[Batch], Hashable]
"""A batch and what is the same of all of its pairs."""

MOST_CORNERS: Final = 512
"""Most corners of a solid of a batch: with more, numbers take the time and not calls."""

FEW_POINTS: Final = 16_384
"""Most points of a cloud that are all looked at: of more, most are left out by groups."""

FEW_COMPILED: Final = 262_144
"""The same where compiled code looks at them."""


class AllPairs:
    """Closest points of a fixed list of pairs, prepared once for all steps.

    Parameters
    ----------
    pairs : sequence of ContactPair
    start : sequence of int, optional
        Of each pair the place of its first contact, among those of which it is written; by default
        they stand one after the other.

    Attributes
    ----------
    n_c : int
        Number of contacts of all pairs.
    """

    def __init__(self, pairs: Sequence[ContactPair], start: Sequence[int] | None = None) -> None:
        counts = [pair.n_c for pair in pairs]
        self.n_c = sum(counts)
        starts = np.cumsum([0, *counts])[:-1].tolist() if start is None else start
        self._rows = [slice(i, i + count) for i, count in zip(starts, counts, strict=True)]
        self._pairs = tuple(pairs)
        self._singly: list[int] = []
        kinds: dict[Kind, list[int]] = defaultdict(list)
        for i, pair in enumerate(pairs):
            kind = kind_of(pair)
            (self._singly if kind is None else kinds[kind]).append(i)
        blocks = [
            (batch, some[first : first + most])
            for (batch, _), some in kinds.items()
            for most in [max(1, CHUNK // pairs[some[0]].candidates)]
            for first in range(0, len(some), most)
        ]
        self._batches = [
            (
                batch([pairs[i] for i in some]),
                np.array(some),
                np.array([np.arange(starts[i], starts[i] + counts[i]) for i in some]),
            )
            for batch, some in blocks
        ]
        # One batch that has all pairs, in order: its contacts are those of all.
        every = [*range(self.n_c)]
        in_order = [batch for batch, _, rows in self._batches if rows.ravel().tolist() == every]
        self._every = in_order[0] if in_order else None

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's as they rank.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite (given NaN, coal would
            answer with a distance of 0).
        """
        n_c = self.n_c
        if self._every is not None:
            check_finite(kinematics)
            known, every = self._every.contacts(kinematics.R, kinematics.t)
            if known.all():
                return ClosestPoints(
                    phi=every.phi.reshape(n_c) + 0.0,  # zero is 0.0, never -0.0
                    alpha=every.alpha.reshape(n_c, 3),
                    beta=every.beta.reshape(n_c, 3),
                    n=every.n.reshape(n_c, 3) + 0.0,
                    point=every.point.reshape(n_c),
                    tie=every.tie.reshape(n_c),
                )
        vectors = np.zeros((3, n_c, 3))
        contacts = ClosestPoints(np.zeros(n_c), *vectors, *np.zeros((2, n_c), dtype=np.int64))
        self.write(kinematics, contacts)
        return contacts

    def write(self, kinematics: Kinematics, contacts: ClosestPoints) -> None:
        """Write the contacts into arrays of shape (n_c, ...); ContactError as of closest_points."""
        check_finite(kinematics)
        R = kinematics.R
        t = kinematics.t
        left = [*self._singly]
        for batch, some, rows in self._batches:
            known, points = batch.contacts(R, t)
            for field, values in zip(contacts, points, strict=True):
                field[rows] = values
            left += some[~known].tolist()
        for i in sorted(left):
            points = pair_closest_points(self._pairs[i], R, t)
            for field, values in zip(contacts, points, strict=True):
                field[self._rows[i]] = values
        for field in (contacts.phi, contacts.n):
            field += 0.0  # zero is 0.0, never -0.0


def check_finite(kinematics: Kinematics) -> None:
    """Refuse poses that are not finite: ContactError."""
    if not (all_finite(kinematics.R.ravel()) and all_finite(kinematics.t.ravel())):
        raise ContactError("must be finite", field="poses")


def closest_points(pairs: Sequence[ContactPair], kinematics: Kinematics) -> ClosestPoints:
    """The contacts of all pairs: the pairs in order, and each pair's contacts by their rank."""
    return AllPairs(pairs).closest_points(kinematics)


def kind_of(pair: ContactPair) -> Kind | None:
    """Which pairs can be searched together with this one: the same kind; None if none can."""
    sides = (pair.alpha.shape, pair.beta.shape)
    cloud_last = isinstance(sides[1], PointCloud)
    cloud, solid = sides[::-1] if cloud_last else sides
    if isinstance(cloud, PointCloud):
        N = len(cloud.points)
        few = N <= FEW_POINTS or (N <= FEW_COMPILED and is_compiled(Clouds.contacts))
        known = isinstance(solid, Rounded | HalfSpace) and few
        return (Clouds, (cloud_last, cloud, pair.n_c)) if known and pair.resolution else None
    ball_last = isinstance(sides[1], Sphere)
    ball, other = sides[::-1] if ball_last else sides
    if isinstance(ball, Sphere) and isinstance(other, Rounded) and pair.n_c == 1:
        return Spheres, ball_last
    if all(isinstance(side, Box | Capsule | Sphere) for side in sides):
        return RoundedBoxes, (*map(type, sides), pair.n_c)
    plane_first = isinstance(sides[0], HalfSpace)
    plane, solid = sides if plane_first else sides[::-1]
    if isinstance(plane, HalfSpace) and _is_over_planes(solid, pair.n_c):
        return OnHalfSpaces, (plane_first, solid.corner_count, pair.n_c)
    return None


def _is_over_planes(solid: Shape, n_c: int) -> bool:
    """Whether the contacts of a solid with half-spaces follow from its corners."""
    if isinstance(solid, Sphere):
        return True
    few = isinstance(solid, Box | Capsule | ConvexMesh) and solid.corner_count <= MOST_CORNERS
    if not few or not _corners_are_apart(solid):
        return False
    return isinstance(solid, Rounded) or 1 < n_c <= int(bearing_corners(solid).sum())


def _corners_are_apart(solid: Shape) -> bool:
    """Whether no corner is where another is: seen from any side, neither repeats the other."""
    corners, _ = solid.corners(DIRECTIONS[0])
    corners = corners[bearing_corners(solid)]
    apart = norm(corners[:, None] - corners)
    return int(np.count_nonzero(apart <= 10 * REPEATED)) == len(corners)
