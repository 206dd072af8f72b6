"""Closest points in compiled code at any poses."""

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.optional.fast.closest import Closest


class PosedPairs:
    """Pairs whose links are put where one likes, L of them, in place of pinocchio's poses."""

    def __init__(self, pairs, L):
        n_c = sum(pair.n_c for pair in pairs)
        self.written = ClosestPoints(
            np.zeros(n_c), *np.zeros((3, n_c, 3)), *np.zeros((2, n_c), int)
        )
        self._columns = np.zeros((L, 3, 3))
        self._t = np.zeros((L, 3))
        link = np.arange(L)
        self.R = self._columns.ctypes.data + 72 * link
        self.t = self._t.ctypes.data + 24 * link
        self._closest = Closest(pairs, self, self.written)

    def closest_points(self, links):
        """The contacts of all pairs where the links are: of ``Kinematics``."""
        self._links = links
        self._columns[:] = links.R.transpose(0, 2, 1)
        self._t[:] = links.t
        self._closest.write()
        return ClosestPoints._make(field.copy() for field in self.written)

    def kinematics(self):
        """The links, as ``Poses`` has them."""
        return self._links
