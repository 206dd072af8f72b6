"""Whether contact forces inside their cones balance a step at a displacement: a linear program."""

import numpy as np
from scipy.optimize import linprog

from quasistatic_ref import standard_form
from tests.tolerances import CLOSED_FORM


def balances(step, x):
    """Whether some lam >= 0 has A'lam = H x - g, in a polyhedral cone.

    Parameters
    ----------
    step : StepData
    x : array_like, shape (n_v,)
        Without slack in any row, or with that of rounding [m, rad].
    """
    H, g, A, b = standard_form(step)
    x = np.asarray(x, dtype=float)
    assert np.abs(A @ x - b).max() <= CLOSED_FORM * (np.abs(A) @ np.abs(x) + np.abs(b)).max()
    lengths = np.abs(A).max(axis=0)
    moved = lengths > 0
    load = (H @ x - g) / np.where(moved, lengths, 1.0)
    size = np.abs(load).max()
    assert np.abs(load[~moved]).max(initial=0.0) <= CLOSED_FORM * size
    found = linprog(
        np.zeros(len(b)), A_eq=(A[:, moved] / lengths[moved]).T, b_eq=load[moved] / size
    )
    assert found.status in (0, 2), found.message
    return found.status == 0
