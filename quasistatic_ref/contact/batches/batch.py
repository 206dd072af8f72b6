"""What batches of pairs have in common."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.shape_in_world import Pose, poses_in_world
from quasistatic_ref.numbers.arrays import Array, Mask


class Batch(ABC):
    """P pairs of one kind, whose contacts are formed at once.

    Each number comes from the operations, in their order, that form it where the pair is searched
    by itself, so that its bits are the same.

    Parameters
    ----------
    pairs : sequence of ContactPair
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        self.links = np.array([[pair.alpha.link, pair.beta.link] for pair in pairs])
        self.poses = np.array([pair.poses for pair in pairs])
        self.size = np.array([pair.size for pair in pairs])
        self.resolution = np.array([pair.resolution for pair in pairs])
        self.n_c = pairs[0].n_c

    @abstractmethod
    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """Ranked contacts of the pairs at poses of the links, (L, 3, 3) and (L, 3) [m].

        Returns
        -------
        known : ndarray of bool, shape (P,)
            False of a pair that is out of the ordinary: it is searched by itself.
        contacts : ClosestPoints
            With fields of shape (P, n_c, ...).
        """

    def in_world(self, R: Array, t: Array) -> tuple[Pose, Pose]:
        """Poses of alpha's and beta's shapes, where the links have the given poses."""
        return poses_in_world(self.links, self.poses, R, t)


def farthest_places(*poses: Pose) -> Array:
    """The largest coordinate of both places of each pair, shape (P,) [m]; `poses` are two."""
    one, other = (np.abs(t).max(axis=1) for _, t in poses)
    return np.asarray(np.maximum(one, other))
