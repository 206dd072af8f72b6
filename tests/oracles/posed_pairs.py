"""Closest points in compiled code at any poses."""

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.optional.fast.compiled.pairs import Pairs


class PosedPairs:
    """Pairs whose links are put where one likes, L of them, in place of pinocchio's poses."""

    def __init__(self, pairs, L):
        n_c = sum(pair.n_c for pair in pairs)
        self.found = ClosestPoints(np.zeros(n_c), *np.zeros((3, n_c, 3)), *np.zeros((2, n_c), int))
        self.columns = np.zeros((L, 3, 3))
        self.t = np.zeros((L, 3))
        link = np.arange(L)
        addresses = self.columns.ctypes.data + 72 * link, self.t.ctypes.data + 24 * link
        self.pairs = Pairs(pairs, *addresses, self.found)

    def put(self, R, t):
        """Put the links at R (L, 3, 3) and t (L, 3) [m]."""
        self.columns[:] = R.transpose(0, 2, 1)
        self.t[:] = t

    def decided(self, R, t):
        """What C finds at those poses, and the numbers of the pairs that it decides."""
        self.put(R, t)
        decided = self.pairs.decided()
        return ClosestPoints._make(field.copy() for field in self.found), decided

    def closest_points(self, R, t):
        """The contacts of all pairs at those poses."""
        self.put(R, t)
        self.pairs.find(self)
        return ClosestPoints._make(field.copy() for field in self.found)

    def kinematics(self):
        """The poses, as ``Poses`` has them."""
        return self

    @property
    def R(self):
        """The rotations."""
        return self.columns.transpose(0, 2, 1)
