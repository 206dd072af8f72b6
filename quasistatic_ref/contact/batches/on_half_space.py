"""Boxes, convex meshes, capsules and spheres on half-spaces, all at once.

Every corner of the solid is a candidate, and the closest pair follows from the corners. A sphere
has one with its radius about it, the centre.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch, farthest_places
from quasistatic_ref.contact.distance import ClosestPoints, contacts_over
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.separations import UNIQUE_NORMAL
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot, product, rotated
from quasistatic_ref.shapes.placed_shape import HalfSpace, Shape, Sphere
from quasistatic_ref.shapes.shape import DIRECTIONS

FAR: Final = 1e3
"""Places relative to the solid's size [-] up to which rounding, 1e-16 of them, is far below the
length to which distances are rounded, 1e-9 of the size: the corners that are lowest then rank as
the closest pair does, and hold it in their hull."""


def ends(solid: Shape) -> tuple[Array, float]:
    """Its corners, shape (N, 3) [m], or its centre; and the radius of the ball about each [m]."""
    if isinstance(solid, Sphere):
        return np.zeros((1, 3)), solid.radius
    return solid.corners(DIRECTIONS[0])


class OnHalfSpaces(Batch):
    """Solids of one number of corners on half-spaces, which all are alpha's or all are beta's."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        self._turn = 1 if isinstance(pairs[0].alpha.shape, HalfSpace) else -1
        sides = [(pair.alpha.shape, pair.beta.shape)[:: self._turn] for pair in pairs]
        planes = [plane for plane, _ in sides if isinstance(plane, HalfSpace)]
        corners = [ends(solid) for _, solid in sides]
        self._normal = np.array([plane.normal for plane in planes])[:, None]
        self._offset = np.array([plane.offset for plane in planes])[:, None]
        self._corners = np.array([points for points, _ in corners])
        self._radius = np.array([radius for _, radius in corners])[:, None]

    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """The n_c corners that rank first."""
        plane, solid = self.in_world(R, t)[:: self._turn]
        towards_plane = plane[0].mT
        turn = product(towards_plane, solid[0])
        place = rotated(towards_plane, solid[1] - plane[1])
        x = rotated(turn[:, None], self._corners) + place[:, None]
        height = dot(x, self._normal) - self._offset
        rank = np.rint((height - self._radius) / self.resolution[:, None])
        order = rank.argsort(axis=1, kind="stable")[:, : self.n_c]
        first = np.arange(len(order))[:, None], order
        corner = self._corners[first]
        height = height[first]
        normal = np.broadcast_to(self._normal, corner.shape)
        surface = height, normal, np.full(order.shape, UNIQUE_NORMAL)
        contacts = contacts_over(plane, solid, corner, self._radius, surface, order)
        places = np.maximum(farthest_places(plane, solid), np.abs(self._offset[:, 0]))
        return places < FAR * self.size, contacts if self._turn > 0 else contacts.swapped()
