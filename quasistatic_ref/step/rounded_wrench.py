"""Contact wrenches of files, each number rounded once."""

from fractions import Fraction

import numpy as np

from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Array, row_layout
from quasistatic_ref.step.friction import cone_matrix


def rounded_wrenches(contacts: Contacts, lam: Array, h: float, name: str = PYRAMID) -> Array:
    """The combination of :func:`~quasistatic_ref.step.friction.contact_wrenches`, rounded once.

    Parameters
    ----------
    contacts, lam, h, name
        As in :func:`~quasistatic_ref.step.friction.contact_wrenches`; lam is finite.

    Returns
    -------
    ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) [N, N m]: each the float64 nearest to the exact combination, which
        ``contact_wrenches`` may miss by the rounding of its sums; infinite beyond float64's range.
    """
    matrix = np.eye(4) if name == ELLIPSOID else cone_matrix(name)
    ends = row_layout(name, contacts.rows.tobytes()).offsets
    wrench = np.zeros((contacts.n_c, 4))
    for j in range(contacts.n_c):
        mu = (1.0, *contacts.mu[j].tolist()) if name != ELLIPSOID else (1.0,) * 4
        impulses = enumerate(lam[ends[j] : ends[j + 1]].tolist())
        pressed = [(Fraction(f), matrix[i].tolist()) for i, f in impulses if f]
        for k, column in enumerate((1, 2, 0, 3)):
            total = sum(Fraction(share[column]) * f for f, share in pressed)
            wrench[j, k] = _nearest(Fraction(mu[column]) * total / Fraction(h))
    return wrench + 0.0


def _nearest(x: Fraction) -> float:
    try:
        return float(x)
    except OverflowError:
        return float("inf") if x > 0 else float("-inf")
