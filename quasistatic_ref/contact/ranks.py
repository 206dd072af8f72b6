"""How contacts rank: by rounded signed distances, among equal ones by their numbers."""

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices


def rounded_gaps(phi: Array, resolution: float) -> Array:
    """Signed distances as numbers of the nearest multiple of a length, for ranking.

    Zero is the middle of its multiple: what touches stays there, however rounding moves it.

    Parameters
    ----------
    phi : ndarray, shape (N,)
        [m].
    resolution : float
        [m]; 0 rounds nothing.

    Returns
    -------
    ndarray, shape (N,)
        [-], or `phi` where nothing is rounded.
    """
    return np.rint(phi / resolution) if resolution else phi


def closest(phi: Array, k: int) -> Indices:
    """Indices of the k smallest signed distances in ascending order, ties broken by index.

    Parameters
    ----------
    phi : ndarray, shape (N,)
    k : int
        All of them if k >= N.

    Returns
    -------
    ndarray of int, shape (min(k, N),)
    """
    if k < len(phi):
        kth = np.partition(phi, k - 1)[k - 1]
        near = np.flatnonzero(~(phi > kth))  # and all that tie with it
        return near[phi[near].argsort(kind="stable")][:k]
    return phi.argsort(kind="stable")
