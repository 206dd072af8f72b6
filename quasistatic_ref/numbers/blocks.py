"""Symmetric matrices that may be kept by the blocks on their diagonal."""

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, read_only


def whole(M: Array) -> Array:
    """All of a matrix, shape (n, n), from its diagonal blocks M, (k, n / k, n / k) [any unit].

    An M that is whole is returned as it is.
    """
    if M.ndim == 2:
        return M
    k, size, _ = M.shape
    wide = np.zeros((k, size, k, size))
    wide[np.arange(k), :, np.arange(k)] = M
    return read_only(wide.reshape(k * size, k * size))


def entries_of(M: Array, some: Indices) -> Array:
    """Rows and columns of a symmetric matrix, shape (k, k) [any unit].

    Parameters
    ----------
    M : ndarray, shape (n, n), or (b, n / b, n / b)
        All of it, or its diagonal blocks [any unit].
    some : ndarray of int, shape (k,)
        Which.
    """
    if M.ndim == 2:
        return np.asarray(M[np.ix_(some, some)])
    block, i = np.divmod(some, M.shape[-1])
    return np.where(block[:, None] == block, M[block[:, None], i[:, None], i], 0.0)


def nonzeros(M: Array) -> tuple[Indices, Indices]:
    """Rows and columns, (k,) each, of the entries of a matrix that are not zero.

    Parameters
    ----------
    M : ndarray, shape (n, n), or (b, n / b, n / b)
        All of it, or its diagonal blocks [any unit].
    """
    *block, i, j = np.nonzero(M)
    first = M.shape[-1] * block[0] if block else 0
    return first + i, first + j
