"""How near the points outside a short list can have come since it was made."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.contact.shortlist import Shortlist
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import UNSEEN

CORNERS = 8
"""Corners of the box around a cloud: no point of it moves farther than the one that moves most."""

_SQRT_3 = float(np.nextafter(np.sqrt(3.0), 2.0))


class Proofs:
    """For P pairs, where the corners were when the list was made, and its two bounds.

    A new one proves nothing, so that every list is made at the first pose.
    """

    def __init__(self, P: int) -> None:
        self.corners = np.zeros((3, P * CORNERS))
        self.n = np.zeros((3, P * CORNERS))
        self.bounds = np.full((2, P), -np.inf)

    def keep(self, p: int, made: Shortlist, corners: Array, size: float) -> None:
        """The list of a pair, and where its corners (8, 3) are in the solid's frame.

        `size` is how far from their origins the numbers of the cloud and the solid go [m].
        """
        own = slice(p * CORNERS, (p + 1) * CORNERS)
        self.corners[:, own], self.n[:, own] = corners.T, made.n[:, None]
        slack = UNSEEN * (size + np.abs(corners).max())
        self.bounds[:, p] = made.by_height - slack, made.by_distance - slack

    def limit(self, corners: Array) -> Array:
        """Below which signed distances (P,) [m] no point outside the lists can have come.

        Parameters
        ----------
        corners : ndarray, shape (3, 8 P)
            Where the corners are now, in the frames of the solids [m].
        """
        u = corners - self.corners
        along, moved = u * self.n, np.abs(u)
        least = np.concatenate(
            [
                along[0] + along[1] + along[2],
                -_SQRT_3 * np.maximum(np.maximum(moved[0], moved[1]), moved[2]),
            ]
        )
        change = least.reshape(2, -1, CORNERS).min(axis=2)
        bounds = self.bounds + change
        # Rounding grows with the distance moved as it does with the sizes.
        return np.asarray(np.minimum(bounds[0], bounds[1]) + UNSEEN * change[1])
