"""J of Eq. :eq:`eq-3` without its zeros, for steps of many bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.step.arrays import Array


@dataclass(frozen=True, eq=False)
class Blocks:
    """Of each contact, the columns of the coordinates that move one of its two bodies.

    Parameters
    ----------
    column : ndarray of int, shape (n_c, w)
        Which columns, ascending; n_v, one beyond the last, where a contact has fewer than w.
    J : ndarray, shape (n_c, 4, w)
        As J of ``Contacts``, those columns; zero where there are fewer.
    n_v : int
        Number of coordinates.
    """

    column: NDArray[np.int64]
    J: Array
    n_v: int

    def dense(self) -> Array:
        """All columns, shape (n_c, 4, n_v)."""
        n_c = len(self.column)
        wide = np.zeros((n_c, 4, self.n_v + 1))
        np.put_along_axis(wide, np.broadcast_to(self.column[:, None], self.J.shape), self.J, axis=2)
        return np.ascontiguousarray(wide[:, :, : self.n_v])

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        own = np.append(delta_q, 0.0)[self.column]
        return np.asarray((self.J @ own[:, :, None])[:, :, 0])
