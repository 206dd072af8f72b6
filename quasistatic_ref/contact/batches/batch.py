"""What batches of pairs have in common."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.normals import FAR_PLACES
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

    def contacts(self, R: Array, t: Array) -> tuple[Mask, ClosestPoints]:
        """Ranked contacts of the pairs at poses of the links, (L, 3, 3) and (L, 3) [m].

        Returns
        -------
        known : ndarray of bool, shape (P,)
            False of a pair that is out of the ordinary: it is searched by itself.
        contacts : ClosestPoints
            With fields of shape (P, n_c, ...).
        """
        alpha, beta = poses_in_world(self.links, self.poses, R, t)
        places = self.places(alpha, beta)
        far = ~(places < FAR_PLACES * self.size)[:, None]
        if not far.any():
            return self.of_poses(alpha, beta, places, places)
        origin, of_alpha, of_beta = self.from_near(alpha, beta)
        alpha = Pose(alpha.R, np.where(far, of_alpha, alpha.t))
        beta = Pose(beta.R, np.where(far, of_beta, beta.t))
        known, points = self.of_poses(alpha, beta, self.places(alpha, beta), places)
        far = far[:, None]
        origin = origin[:, None]
        return known, points._replace(
            alpha=np.where(far, points.alpha + origin, points.alpha),
            beta=np.where(far, points.beta + origin, points.beta),
        )

    @abstractmethod
    def of_poses(
        self, alpha: Pose, beta: Pose, seen: Array, places: Array
    ) -> tuple[Mask, ClosestPoints]:
        """Ranked contacts at poses of both; :meth:`places` as `seen` and in the world, (P,) [m].

        Returns
        -------
        known, contacts
            As of :meth:`contacts`.
        """

    def places(self, alpha: Pose, beta: Pose) -> Array:
        """Largest coordinate of either body's origin, for each of P pairs, shape (P,) [m]."""
        return np.asarray(np.maximum(np.abs(alpha.t), np.abs(beta.t)).max(axis=1))

    def from_near(self, alpha: Pose, beta: Pose) -> tuple[Array, Array, Array]:
        """A point near each pair, and both bodies' origins seen from there, shape (P, 3) [m]."""
        return beta.t, alpha.t - beta.t, np.zeros_like(beta.t)
