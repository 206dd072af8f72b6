"""Which rows bear in a QP, by DAQP: the corrections of a start of the exact method."""

import daqp
import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices

BEARS = 1e-12
"""Least multiplier of a row that bears [-]."""


def bearing_rows(H: Array, f: Array, A: Array, lower: Array) -> Indices:
    """The rows that bear at the optimum of min 1/2 x'Hx + f'x s.t. A x >= lower.

    Parameters
    ----------
    H, f, A, lower : ndarray, shapes (n, n), (n,), (m, n) and (m,)
        Numbers near one [-].

    Returns
    -------
    ndarray of int
        The largest multiplier first; none where DAQP finds no optimum.
    """
    upper = np.full(len(lower), np.inf)
    sense = np.zeros(len(lower), np.int32)
    _, _, flag, info = daqp.solve(H, f, np.ascontiguousarray(A), upper, lower, sense)
    lam = -np.asarray(info["lam"])
    order = np.argsort(-lam, kind="stable")
    return order[: np.count_nonzero(lam > BEARS) if flag == 1 else 0]
