"""The rows that a solver's answer shows to be active, from which the exact method starts.

An interior-point method returns positive multipliers for all six rows of a sticking contact, whose
rank is four. The exact method needs independent rows with multipliers >= 0. Such a choice exists
(Caratheodory): moving lam along a dependence of the rows with positive multipliers changes neither
A'lam nor the optimum, and each move makes one multiplier zero.
"""

import numpy as np

from quasistatic_ref.numbers.arrays import Array

ZERO_SHARE = 1e-9
"""Singular values, and entries of a dependence, below this share of the largest count as zero; a
wrong start costs steps of the active-set method, not correctness."""
BLOCK = 256
"""Most rows whose dependences are formed at once: the time for that is cubic in their number."""


def warm_rows(A: Array, lam: Array, slack: Array) -> list[int]:
    """Independent rows that carry A'lam, the largest multiplier first.

    Parameters
    ----------
    A : ndarray, shape (m, n_v)
    lam, slack : ndarray, shape (m,)
        A solver's multipliers and A delta_q - b; all in natural units (numbers near one).

    Returns
    -------
    list of int
        A start for :func:`~quasistatic_ref.certify.exact.step_optimum`, as good as the answer.
    """
    pressed = np.flatnonzero(lam > np.maximum(slack, 0))
    basic = _basic(A[pressed], lam[pressed])
    kept = basic > 0
    order = np.argsort(-basic[kept], kind="stable")
    return [int(i) for i in pressed[kept][order]]


def basic_rows(lam: Array) -> list[int]:
    """The rows of multipliers that belong to independent rows already, in that order, (m,) [-]."""
    return [int(i) for i in np.argsort(-lam, kind="stable")[: np.count_nonzero(lam > 0)]]


def _basic(A: Array, lam: Array) -> Array:
    """Lam >= 0 of the same A'lam whose positive entries belong to independent rows.

    A block of rows after the other, each with the rows that are kept of those before it.
    """
    lam = lam.copy()
    kept = np.arange(0)
    for first in range(0, len(A), BLOCK):
        rows = np.concatenate([kept, np.arange(first, min(first + BLOCK, len(A)))])
        lam[rows] = _basic_of_block(A[rows], lam[rows])
        kept = rows[lam[rows] > 0]
    return lam


def _basic_of_block(A: Array, lam: Array) -> Array:
    """What :func:`_basic` is of so few rows that all of their dependences can be formed."""
    dependences = np.eye(len(A))
    if A.size:
        _, size, directions = np.linalg.svd(A.T)
        rank = np.count_nonzero(size > ZERO_SHARE * size[0])
        dependences = directions[rank:].T
    while dependences.shape[1]:
        d = dependences[:, 0]
        rounding = ZERO_SHARE * np.abs(d).max()
        d = d if d.max() > rounding else -d
        falling = np.flatnonzero(d > rounding)
        first = int(falling[np.argmin(lam[falling] / d[falling])])
        lam = np.maximum(lam - lam[first] / d[first] * d, 0)
        lam[first] = 0
        rest = dependences[:, 1:]
        dependences = rest - np.outer(d / d[first], rest[first])  # none uses that row again
        dependences[first] = 0
    return lam
