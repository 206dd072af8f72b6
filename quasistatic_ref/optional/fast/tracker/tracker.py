"""The contacts of all pairs, followed from step to step: the same bits as the brute force."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.distance import (
    ClosestPoints,
    check_finite,
    joined,
    pair_closest_points,
)
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.fast.tracker.cloud_tracker import CloudTracker
from quasistatic_ref.step.data import Array


class ContactTracker:
    """What :func:`~quasistatic_ref.contact.distance.closest_points` returns, in less time.

    A tracker remembers which points of the clouds can come among the closest, so each run has a
    tracker of its own. Poses may jump; that costs time only. Pairs of two solids are measured
    at each step: the number of their contacts is fixed, and the distance of each is part of the
    step, near or far.

    Parameters
    ----------
    pairs : sequence of ContactPair

    Attributes
    ----------
    clouds : CloudTracker or None
        Of the pairs in which one side is a cloud.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        with_cloud = [pair for pair in pairs if pair.has_cloud]
        self.clouds = CloudTracker(with_cloud) if with_cloud else None
        self.solids = [pair for pair in pairs if not pair.has_cloud]
        # Contacts are found clouds first, and returned in the order of the pairs.
        owner = np.repeat(np.arange(len(pairs)), [pair.n_c for pair in pairs])
        found = sorted(owner.tolist(), key=lambda i: (not pairs[i].has_cloud, i))
        self._order = np.argsort(found, kind="stable")

    def closest_points(self, R: Array, t: Array) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's in ascending distance.

        Parameters
        ----------
        R, t : ndarray, shapes (L, 3, 3) and (L, 3)
            Poses of the links, as in :class:`~quasistatic_ref.model.system.Kinematics`.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite.
        """
        if self.clouds is not None and not self.solids:
            return self.clouds.closest_points(R, t)
        check_finite(R, t)
        found = [pair_closest_points(pair, R, t) for pair in self.solids]
        if self.clouds is not None:
            found.insert(0, self.clouds.closest_points(R, t))
        return joined(found).chosen(self._order)
