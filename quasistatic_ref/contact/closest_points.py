"""Contacts of pairs: closest points, signed distances and normals, in the world frame."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.quoting import counted


class ClosestPoints(NamedTuple):
    """Contacts, in the world frame.

    ``simulator.closest_points`` makes them; their constructor checks nothing.

    Parameters
    ----------
    phi : ndarray, shape (n_c,)
        Signed distance [m].
    alpha, beta : ndarray, shape (n_c, 3)
        Closest points on alpha's body and on beta's [m]; beta - alpha = phi n.
    n : ndarray, shape (n_c, 3)
        Unit normal from alpha's body to beta's, also in penetration.
    point : ndarray of int, shape (n_c,)
        Index of the cloud's point; for two solids the number of the candidate, or 0 if only
        one is kept; contacts that fill the number follow the closest pair's.
    tie : ndarray of int, shape (n_c,)
        How the normal was chosen, as :mod:`~quasistatic_ref.contact.normals` counts it.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> result = scenario.simulator().step(scenario.system.q_start)
    >>> points: qr.ClosestPoints = result.points
    >>> points
    <ClosestPoints of 1 contact, phi from 0 m>
    """

    phi: Array
    alpha: Array
    beta: Array
    n: Array
    point: Indices
    tie: Indices

    def __repr__(self) -> str:
        nearest = f", phi from {self.phi.min():.3g} m" if self.phi.size else ""
        return f"<{type(self).__name__} of {counted(self.phi.size, 'contact')}{nearest}>"

    def swapped(self) -> "ClosestPoints":
        """The same contacts with alpha's and beta's bodies exchanged."""
        return self._replace(alpha=self.beta, beta=self.alpha, n=-self.n)

    def chosen(self, index: Indices | Mask | tuple[Indices, ...]) -> "ClosestPoints":
        """The contacts of an `index`, in its order and shape."""
        return ClosestPoints._make(field[index] for field in self)


def joined_contacts(lists: Sequence[ClosestPoints]) -> ClosestPoints:
    """Several lists of contacts as one, in which zero is 0.0, never -0.0."""
    if not lists:
        empty = np.zeros((0, 3))
        none = np.zeros(0, dtype=np.int64)
        return ClosestPoints(np.zeros(0), empty, empty, empty, none, none)
    every = ClosestPoints(*map(np.concatenate, zip(*lists, strict=True)))
    return every._replace(phi=every.phi + 0.0, n=every.n + 0.0)
