"""How the load g - H x of Eq. :eq:`eq-13` changes with what it is made of: (R35).

By q it changes by h K_q d(q_bar_a (-) q_a), by h times the change of gravity's force, and by
-d(M_u) x_u / h, which other modules know.
"""

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData


def load_rates(step: StepData, x: Array) -> dict[str, Array]:
    """Derivatives of the load at a fixed displacement x.

    Parameters
    ----------
    step : StepData
    x : ndarray, shape (n_v,)
        [m, rad]

    Returns
    -------
    dict of str to ndarray, shape (n_v, P)
        By ``"delta_q_bar_a"``, ``"tau"``, the diagonal ``"K_q"`` and ``"h"`` [N s per unit].
    """
    h = step.h
    unmoved = np.zeros((step.n_u, step.n_a))
    stretch = step.delta_q_bar_a - x[: step.n_a]
    actuated = step.K_q @ stretch + step.tau_a
    un_actuated = step.M_u @ x[step.n_a :] / h**2 + step.tau_u
    return {
        "delta_q_bar_a": np.concatenate([h * step.K_q, unmoved]),
        "tau": h * np.eye(step.n_v),
        "K_q": np.concatenate([h * np.diag(stretch), unmoved]),
        "h": np.concatenate([actuated, un_actuated])[:, None],
    }
