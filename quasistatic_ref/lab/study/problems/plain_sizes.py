"""The sizes of a quadratic program whose numbers are taken as they are."""

import numpy as np
from scipy.sparse import csr_matrix

from quasistatic_ref.optional.large.sizes import LARGEST
from quasistatic_ref.step.data import Array


class PlainSizes:
    """Sums of the sizes of all terms of A x, A'lam and g: what a bound of rounding needs.

    Parameters
    ----------
    A : csr_matrix, shape (m, n)
    g : ndarray, shape (n,)
    """

    def __init__(self, A: csr_matrix, g: Array) -> None:
        self._A, self.load = abs(A), np.abs(g)
        self.row_terms = int(np.diff(A.indptr).max(initial=0))
        self.column_terms = int(np.diff(A.tocsc().indptr).max(initial=0))
        largest = (A.data, g)
        self.usable = all(float(np.abs(v).max(initial=0.0)) <= LARGEST for v in largest)

    def rows(self, x: Array) -> Array:
        """Of A x, shape (m,), from x (n,)."""
        return np.asarray(self._A @ np.abs(x))

    def columns(self, lam: Array) -> Array:
        """Of A'lam, shape (n,), from lam >= 0 (m,)."""
        return np.asarray(self._A.T @ lam)
