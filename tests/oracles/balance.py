"""Whether contact forces inside their cones balance a step at a displacement: least squares."""

import numpy as np
from scipy.optimize import nnls

from quasistatic_ref import standard_form
from tests.tolerances import ACTIVE_SET, CLOSED_FORM


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
    lengths[lengths == 0] = 1.0
    load = (H @ x - g) / lengths
    _, off = nnls((A / lengths).T, load)
    return bool(off <= ACTIVE_SET * np.linalg.norm(load))
