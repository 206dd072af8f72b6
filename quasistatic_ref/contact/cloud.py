"""The points of a cloud that are closest to a solid."""

import numpy as np

from quasistatic_ref.step.data import Array, Indices


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
        # Only what can be among the k smallest is sorted; every tie stays in the running.
        candidates = np.flatnonzero(~(phi > np.partition(phi, k - 1)[k - 1]))
    else:
        candidates = np.arange(len(phi))
    return candidates[np.argsort(phi[candidates], kind="stable")[:k]]
