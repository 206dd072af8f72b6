"""Sums of a few products in one order: the same bits on every processor.

``@`` leaves to a BLAS in which order the products of an entry are added, and whether a product and
its sum are rounded together: its kernels, chosen by processor, do otherwise. Here the numbers are
multiplied and added elementwise, from the first index to the last, and each operation is rounded as
IEEE 754 says: by loops over what is summed (3 coordinates, 6 of a twist), never over points, or by
``np.add.accumulate``, whose last partial sum is that of all numbers, added in their order.
docs/exactness.md says which numbers of a run are formed so.
"""

from collections.abc import Iterable
from functools import reduce
from operator import add

import numpy as np

from quasistatic_ref.numbers.arrays import Array

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
        return np.asarray(np.add.accumulate(A * B, axis=-1)[..., -1])
    if A.ndim == 1:
        return np.asarray(np.add.accumulate(A[:, None] * B, axis=-2)[..., -1, :])
    sums: Array = A[..., :1] * B[..., None, 0, :]
    for i in range(1, A.shape[-1]):
        sums += A[..., i : i + 1] * B[..., None, i, :]
    return sums


def rotated(R: Array, points: Array) -> Array:
    """Points (..., 3) turned by R, shape (3, 3), or one for each, shape (..., 3, 3) [any unit]."""
    turned: Array = points[..., :1] * R[..., 0]
    turned += points[..., 1:2] * R[..., 1]
    turned += points[..., 2:] * R[..., 2]
    return turned


def dot(a: Array, b: Array) -> Array:
    """Products a . b, shape (...), of vectors of shape (..., 3) [any unit]."""
    products = a * b
    return np.asarray(products[..., 0] + products[..., 1] + products[..., 2])


def norm(vectors: Array) -> Array:
    """Lengths, shape (...), of vectors of shape (..., n) [their unit]."""
    return np.sqrt(np.add.accumulate(vectors * vectors, axis=-1)[..., -1])


def length(vector: Array) -> float:
    """Length of one vector, shape (n,) [its unit], whose squares may leave float64's range."""
    power = int(np.frexp(np.abs(vector).max())[1])
    return float(np.ldexp(norm(np.ldexp(vector, -power)), power))


def crossed(a: Array, b: Array, axis: int = 1) -> Array:
    """Vector products a x b, shape (N, 3, ...); of few vectors np.cross takes three times as long.

    Parameters
    ----------
    a, b : ndarray, shape (N, 3, ...)
        Of any units; an axis of length 1 in the one stands for all of the other [-].
    axis : int
        Along which the vectors stand.
    """
    products: Array = a.take(YZX, axis) * b.take(ZXY, axis)
    products -= a.take(ZXY, axis) * b.take(YZX, axis)
    return products
