"""Spheres on spheres, capsules and boxes, all at once: closest pairs alone."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.batches.batch import Batch, farthest_places
from quasistatic_ref.contact.distance import ClosestPoints, contacts_over
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.separations import TIED_FACES, UNIQUE_NORMAL
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import rotated
from quasistatic_ref.shapes.placed_shape import Sphere
from quasistatic_ref.shapes.rounded import Rounded, distance_to_rounded_box


class Spheres(Batch):
    """Spheres, all of one side, on solids that are :class:`Rounded`."""

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        super().__init__(pairs)
        self._turn = 1 if isinstance(pairs[0].beta.shape, Sphere) else -1
        sides = [(pair.alpha.shape, pair.beta.shape)[:: self._turn] for pair in pairs]
        self._radius = np.array([ball.radius for _, ball in sides if isinstance(ball, Sphere)])
        cores = [solid.core for solid, _ in sides if isinstance(solid, Rounded)]
        self._cores = np.array([half for half, _ in cores])
        self._balls = np.array([radius for _, radius in cores])
        self._extent = np.array([max(shape.extent for shape in side) for side in sides])

    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """The closest pair of each; of those that touch by their cores, which is not unique."""
        solid, ball = self.in_world(R, t)[:: self._turn]
        x = rotated(solid[0].mT, ball[1] - solid[1])
        phi, normal = distance_to_rounded_box(x, self._cores, self._balls)
        within = TIED_FACES * np.maximum(farthest_places(solid, ball), self._extent)
        known = phi - self._radius + (self._balls + self._radius) > within
        tie = np.full((len(x), 1), UNIQUE_NORMAL)
        surface = phi[:, None], normal[:, None], tie
        centre = np.zeros((len(x), 1, 3))
        contacts = contacts_over(solid, ball, centre, self._radius[:, None], surface, 0 * tie)
        return known, contacts if self._turn > 0 else contacts.swapped()
