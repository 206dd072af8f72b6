"""A strictly feasible direction for the rows of a large step that are nearly tight."""

import numpy as np
from scipy.sparse import csc_matrix, diags, identity
from scipy.sparse.linalg import splu

from quasistatic_ref.step.data import Array

ROUNDS = 500
"""Corrections of the direction. A heap of 100 boxes needs some ten, a row of 160 a hundred."""

NEAR = 1.0
"""Slack [-] in natural units up to which a row a_i must have a_i v > 0: all other rows stay
feasible when x is moved along v by as little as a solver's rounding."""

RIDGE = 1e-3
"""Added to the diagonal of A'A, the rows of A having length one: without it A'A is singular where a
body touches nothing."""


def opening(A: csc_matrix, slack: Array, ridge: float = RIDGE) -> Array | None:
    """A direction v with a_i v > 0 for all rows a_i that are nearly tight, or None.

    Parameters
    ----------
    A : scipy.sparse.csc_matrix, shape (m, n_v)
        In natural units [-].
    slack : ndarray, shape (m,)
        A x - b [-].
    ridge : float
        Less of it finds directions in narrower wedges, and is rounded worse [-].

    Returns
    -------
    ndarray, shape (n_v,), or None
        Found by accelerated alternating projections; the caller has to check it.
    """
    length = np.sqrt(np.bincount(A.indices, A.data * A.data, minlength=len(slack)))
    near = slack <= NEAR
    if not length[near].all():
        return None
    scale = np.divide(near, length, out=np.zeros(len(slack)), where=near)
    B = (diags(scale) @ A).tocsc()
    # A ridge, since a pseudo-inverse would be dense: the same limit in a few more rounds.
    normal = (B.T @ B + ridge * identity(B.shape[1])).tocsc()
    factor = splu(normal, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    d = before = np.zeros(B.shape[1])
    # Alternating projections of z = B v (d here) to {z >= 1} and to the range of B: Cheney and
    # Goldstein (1959).
    for k in range(ROUNDS):
        short = np.maximum(near - B @ d, 0.0)
        if short.max(initial=0.0) < 0.5:
            return d
        after = d + factor.solve(B.T @ short)
        d, before = after + k / (k + 3) * (after - before), after  # Nesterov (1983)
    return None
