"""What is coupled, through whatever: labels of connected components."""

import numpy as np

from quasistatic_ref.numbers.arrays import Indices, Mask


def components(couplings: Mask) -> tuple[Indices, Indices]:
    """The group of each coordinate and of each coupling, from a mask, shape (couplings, n)."""
    coupling, coordinate = np.nonzero(couplings)
    return connected_components(coupling, coordinate, couplings.shape)


def connected_components(
    coupling: Indices, coordinate: Indices, shape: tuple[int, ...]
) -> tuple[Indices, Indices]:
    """The first coordinate of the group of each coordinate, (n,), and of each coupling.

    Each coordinate takes the least label among those that share a coupling with it, until no label
    changes. A coupling without coordinates has label 0.

    Parameters
    ----------
    coupling, coordinate : ndarray of int, shape (k,)
        Numbers of couplings, and of coordinates that they couple.
    shape : tuple of int
        Number of couplings, and of coordinates.
    """
    count, n = shape
    label = np.arange(n)
    while True:
        least = np.full(count, n)
        np.minimum.at(least, coupling, label[coordinate])
        lower = label.copy()
        np.minimum.at(lower, coordinate, least[coupling])
        lower = lower[lower]  # a label is a coordinate of the same group
        if np.array_equal(lower, label):
            return label, np.where(least < n, least, 0)
        label = lower
