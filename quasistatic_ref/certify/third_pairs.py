"""Rows of the pyramid that bear where two others of their contact do."""

from typing import Final

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.data import StepData

PAIRS: Final = np.array([[0, 2], [1, 3], [4, 5]])
"""Rows +d1 and -d1, +d2 and -d2, +spin and -spin of a contact in the pyramid."""
TWICE_THE_GAP: Final = np.array([2.0, 0.0, 0.0, 0.0])
"""What the rows of each pair add up to, by their coefficients in the cone [-]."""


def third_pair_rows(step: StepData, A: Array, x: Array, lam: Array) -> Indices:
    """Rows that bear in the pyramid, however little, by the rows that bear in float64; (k,).

    The rows of a pair add up to twice the gap. Where one pair of a contact bears and one row of
    another pair, the gap and two of slip 1, slip 2 and spin are therefore zero, and the slacks of
    the third pair are s and -s: one of them is violated unless s = 0, which is 1e-17 m or so. Here
    the sign of s is that of float64.

    Parameters
    ----------
    step : StepData
    A : ndarray, shape (m_c, w)
        The contacts' rows by their own columns [m].
    x, lam : ndarray, shapes (n_v,) and (m,)
        A solver's displacement and multipliers, each times any number.
    """
    none = np.zeros(0, np.int64)
    if step.cone != PYRAMID:
        return none
    if (cone(PYRAMID).matrix[PAIRS].sum(axis=1) != TWICE_THE_GAP).any():  # rows of one's own
        return none
    mask = step.mask
    bears = np.zeros(mask.shape, dtype=bool)
    bears[mask] = lam[: step.offsets[-1]] > 0
    count = bears[:, PAIRS].sum(axis=2)
    of_three = (count.sum(axis=1) == 3) & mask[:, -1]
    contact, pair = np.nonzero((count == 0) & of_three[:, None])
    if not contact.size:
        return contact
    rows = step.offsets[contact, None] + PAIRS[pair]
    moved = np.append(x, 0.0)[step.contacts.column[contact]]
    s = ((A[rows[:, 0]] - A[rows[:, 1]]) * moved).sum(axis=1)
    return np.asarray(np.where(s < 0, rows[:, 0], rows[:, 1])[s != 0])
