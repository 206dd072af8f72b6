"""Which rows a solver's answer shows to be active."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.step.data import Array


def warm_rows(lam: Array, slack: Array) -> list[int]:
    """Rows that are more pressed than open, the most pressed first.

    Parameters
    ----------
    lam, slack : ndarray, shape (m,)
        A solver's multipliers and A delta_q - b, in natural units (as numbers near one).

    Returns
    -------
    list of int
    """
    pressed = np.flatnonzero(lam > slack)
    return [int(i) for i in pressed[np.argsort(-lam[pressed], kind="stable")]]
