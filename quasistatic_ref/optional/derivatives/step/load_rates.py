"""How the load g - H x of Eq. :eq:`eq-13` changes with what it is made of: (R35).

By q it changes by h K_q d(q_bar_a (-) q_a), by h times the change of gravity's force, and by
-d(M_u) x_u / h, which other modules know.
"""

import numpy as np

from quasistatic_ref.step.data import Array


def load_rates(
    h: float, K_q: Array, M_u: Array, tau: Array, delta_q_bar_a: Array, x: Array
) -> dict[str, Array]:
    """Derivatives of the load at a fixed displacement x.

    Parameters
    ----------
    h : float
        [s]
    K_q : ndarray, shape (n_a, n_a)
        [N/m, N m/rad]
    M_u : ndarray, shape (n_u, n_u)
        [kg, kg m, kg m^2]
    tau : ndarray, shape (n_v,)
        tau_a and tau_u [N, N m].
    delta_q_bar_a : ndarray, shape (n_a,)
        [m, rad]
    x : ndarray, shape (n_v,)
        [m, rad]

    Returns
    -------
    dict of str to ndarray, shape (n_v, P)
        By ``"delta_q_bar_a"``, ``"tau"``, the diagonal ``"K_q"`` and ``"h"`` [N s per unit].
    """
    n_a = len(K_q)
    unmoved = np.zeros((len(M_u), n_a))
    stretch = delta_q_bar_a - x[:n_a]
    forces = np.concatenate([K_q @ stretch + tau[:n_a], M_u @ x[n_a:] / h**2 + tau[n_a:]])
    return {
        "delta_q_bar_a": np.concatenate([h * K_q, unmoved]),
        "tau": h * np.eye(len(x)),
        "K_q": np.concatenate([h * np.diag(stretch), unmoved]),
        "h": forces[:, None],
    }
