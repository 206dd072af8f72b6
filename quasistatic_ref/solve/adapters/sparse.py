"""Dense arrays as compressed columns whose pattern is fixed, zeros included."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

from quasistatic_ref.step.data import Array


def full_columns(A: Array) -> Any:
    """All entries of A; its data in place are ``A.ravel(order="F")``.

    Parameters
    ----------
    A : ndarray, shape (m, n)

    Returns
    -------
    scipy.sparse.csc_matrix
    """
    m, n = A.shape
    rows, starts = np.tile(np.arange(m), n), np.arange(n + 1) * m
    return csc_matrix((A.ravel(order="F"), rows, starts), shape=(m, n))


def upper_triangle(H: Array) -> tuple[Any, tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """The upper triangle of H, and where its data are in H: ``H[where]``.

    Parameters
    ----------
    H : ndarray, shape (n, n)

    Returns
    -------
    scipy.sparse.csc_matrix, tuple of ndarray
        Of shape (n, n); rows and columns, shape (n (n + 1) / 2,) each.
    """
    n = len(H)
    columns, rows = np.tril_indices(n)  # column by column, each from its first row
    starts = np.concatenate([[0], np.cumsum(np.arange(1, n + 1))])
    return csc_matrix((H[rows, columns], rows, starts), shape=(n, n)), (rows, columns)
