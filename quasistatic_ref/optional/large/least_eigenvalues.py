r"""Lower bounds of the eigenvalues of a block diagonal matrix, in float64.

For any number c and any matrix L,

.. math:: \lambda_{min}(H) \ge c - \|H - c I - L L^T\|_\infty,

because L L' has no negative eigenvalue. L is the Cholesky factor of H - c I, of which nothing
needs to be true, and c half of the smallest eigenvalue, about.
"""

from collections.abc import Iterator

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.csgraph import connected_components

from quasistatic_ref.optional.large.outward import above, below
from quasistatic_ref.optional.large.sizes import rounding
from quasistatic_ref.step.data import Array, Indices


def least_eigenvalues(H: csc_matrix) -> Array:
    """For each coordinate a lower bound of the smallest eigenvalue of its block, shape (n_v,) [-].

    Parameters
    ----------
    H : scipy.sparse.csc_matrix, shape (n_v, n_v)
        Symmetric, each entry rounded once.

    Returns
    -------
    ndarray, shape (n_v,)
        Not positive where nothing is shown.
    """
    least = np.zeros(H.shape[0])
    for coordinates, blocks in diagonal_blocks(H):
        least[coordinates] = _least(blocks)[:, None]
    return least


def diagonal_blocks(H: csc_matrix) -> Iterator[tuple[Indices, Array]]:
    """Blocks of one size s after the other: their coordinates (k, s), and themselves (k, s, s)."""
    _, label = connected_components(H, directed=False)
    order = np.argsort(label, kind="stable")
    size = np.bincount(label)
    for s in np.unique(size):
        coordinates = order[size[label[order]] == s].reshape(-1, s)
        row = np.repeat(coordinates, s, axis=1)
        column = np.tile(coordinates, s)
        yield coordinates, np.asarray(H[row.ravel(), column.ravel()]).reshape(-1, s, s)


def _least(blocks: Array) -> Array:
    """The bound of each of some blocks, shape (k,), from (k, s, s)."""
    s = blocks.shape[1]
    try:
        c = np.linalg.eigvalsh(blocks)[:, :1, None] / 2 * np.eye(s)
        L = np.linalg.cholesky(blocks - c)
    except np.linalg.LinAlgError:
        return np.zeros(len(blocks))
    defect = np.abs(blocks - c - L @ L.transpose(0, 2, 1))
    sizes = np.abs(blocks) + c + np.abs(L) @ np.abs(L).transpose(0, 2, 1)
    off = np.sum(above(defect + rounding(s, sizes)), axis=2)
    most = above(off + rounding(s, off)).max(axis=1)
    return below(c[:, 0, 0] - most)
