"""Sums of a few products in one order: the same bits on every processor.

``@`` leaves to a BLAS in which order the products of an entry are added, and whether a product and
its sum are rounded together: its kernels, chosen by processor, do otherwise. Here the numbers are
multiplied and added elementwise, from the first index to the last, and each operation is rounded as
IEEE 754 says. Loops run over what is summed (3 coordinates, 6 of a twist), never over points.
docs/exactness.md says which numbers of a run are formed so.
"""

from collections.abc import Iterable
from functools import reduce
from operator import add

import numpy as np

from quasistatic_ref.step.arrays import Array

YZX = np.array([1, 2, 0])
ZXY = np.array([2, 0, 1])


def total(terms: Iterable[Array]) -> Array:
    """The sum of arrays, from the first to the last.

    Parameters
    ----------
    terms : iterable of ndarray
        At least one, all of one shape [one unit].

    Returns
    -------
    ndarray, of their shape
    """
    return np.asarray(reduce(add, terms))


def product(A: Array, B: Array) -> Array:
    """The product of matrices, stacks of matrices or vectors that ``A @ B`` stands for.

    Parameters
    ----------
    A : ndarray, shape (..., m, k) or (k,)
        [any unit].
    B : ndarray, shape (..., k, n) or (k,)
        [any unit].

    Returns
    -------
    ndarray, shape (..., m, n), without m or n where a factor is a vector
    """
    if B.ndim == 1:
        if not len(B):
            return np.zeros(A.shape[:-1])
        return total(A[..., i] * B[i] for i in range(len(B)))
    if A.ndim == 1:
        return total(A[i] * B[..., i, :] for i in range(len(A)))
    return total(A[..., i, None] * B[..., None, i, :] for i in range(A.shape[-1]))


def rotated(R: Array, points: Array) -> Array:
    """Points (..., 3) turned by R, shape (3, 3), or one for each, shape (..., 3, 3) [any unit]."""
    return total(points[..., i, None] * R[..., i] for i in range(3))


def dot(a: Array, b: Array) -> Array:
    """Products a . b, shape (...), of vectors of shape (..., 3) [any unit]."""
    products = a * b
    return np.asarray(products[..., 0] + products[..., 1] + products[..., 2])


def norm(vectors: Array) -> Array:
    """Lengths, shape (...), of vectors of shape (..., n) [their unit]."""
    squares = vectors * vectors
    return np.sqrt(total(squares[..., i] for i in range(vectors.shape[-1])))


def length(vector: Array) -> float:
    """Length of one vector, shape (n,) [its unit], whose squares may leave float64's range."""
    power = int(np.frexp(np.abs(vector).max())[1])
    return float(np.ldexp(norm(np.ldexp(vector, -power)), power))


def crossed(a: Array, b: Array) -> Array:
    """Vector products a x b, shape (N, 3, ...); of few vectors np.cross takes three times as long.

    Parameters
    ----------
    a, b : ndarray, shape (N, 3, ...)
        Of any units; an axis of length 1 in the one stands for all of the other [-].
    """
    products: Array = a[:, YZX] * b[:, ZXY] - a[:, ZXY] * b[:, YZX]
    return products


def cross_matrix(r: Array) -> Array:
    """[r x], shape (..., 3, 3), of vectors r, shape (..., 3) [any unit]: [r x] w = r x w."""
    columns = crossed(r.reshape(-1, 3, 1), np.eye(3)[None])
    return columns.reshape(*r.shape, 3)
