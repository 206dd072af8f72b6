r"""A guess, in float64, of the faces that forces lie on: where their exact method starts.

Multipliers of the step with compliance c (:mod:`~quasistatic_ref.certify.compliance.forces`) solve
its dual, a least-squares problem in numbers >= 0. With A delta_q - b = C z and H = L L^T it is

.. math:: \min_{\lambda \ge 0} \; \|L^{-1} (g + A^T \lambda)\|^2
          + \|\sqrt{c / h}\, C^T \lambda + \sqrt{h / c}\, z_0\|^2,

where z_0 is z at delta_q = 0. The rows of a face are those with a multiplier. The user's own rows
are rigid in the exact method. In the guess each of them gives way a little, by a length of its own.
"""

from typing import Final

import numpy as np

from quasistatic_ref.certify.compliance.faces import Rows, cone_rows, rows_of
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import friction_rows
from quasistatic_ref.step.standard_form import linear_term

ROUNDING: Final = 2.0**-50
"""Of a product with a column of length one, relative to the other factor."""
MOST: Final = 3
"""Entries that become positive, at most, for each that there is."""
REFINED: Final = 3
"""Solutions of the normal equations, each for what the one before left. They take a hundredth of
the time of a singular value decomposition of M, and two more make them as accurate."""
STIFF: Final = 2.0**5
"""By which a user's row is multiplied. Its stiffness is the square of that times a contact's."""


def guessed_faces(step: StepData, compliance: float) -> list[Rows]:
    """The face of each contact, in a polyhedral cone.

    Where float64 does not suffice, the guess is that no contact bears a load.

    Parameters
    ----------
    step : StepData
    compliance : float
        [m/N].

    Returns
    -------
    list of tuple of int, length n_c
    """
    n_c = step.contacts.n_c
    if not n_c:
        return []
    try:
        lam = _multipliers(step, compliance)
    except ValueError:
        return [()] * n_c
    faces = []
    for j, count in enumerate(step.counts.tolist()):
        lam_j = lam[step.offsets[j] : step.offsets[j + 1]]
        rows = warm_rows(rows_of(step.cone, count), lam_j, np.zeros(count))
        faces.append(tuple(sorted(rows)))
    return faces


def _multipliers(step: StepData, compliance: float) -> Array:
    """The multipliers of the step with compliance, shape (m,) [N s].

    Raises
    ------
    ValueError
        If H is not positive definite in float64, or an entry of the problem is not finite.
    """
    own = step.extra
    n_own = len(own.b)
    of_contacts = cone_rows(step)
    contact_rows, lengths = of_contacts.shape
    C = np.zeros((step.m, lengths + n_own))
    C[:contact_rows, :lengths] = of_contacts
    C[contact_rows:, lengths:] = np.eye(n_own)
    A = np.vstack([friction_rows(step.contacts, step.cone)[step.mask], STIFF * own.A])
    gap = np.zeros((step.contacts.n_c, 4))
    gap[:, 0] = step.contacts.phi
    z_0 = np.concatenate([gap.ravel(), -STIFF * own.b])
    L = np.linalg.cholesky(step.H)
    root = np.sqrt(compliance / step.h)
    M = np.vstack([np.linalg.solve(L, A.T), root * C.T])
    d = np.concatenate([np.linalg.solve(L, linear_term(step)), z_0 / root])
    return nonnegative_least_squares(M, -d)


def nonnegative_least_squares(M: Array, d: Array) -> Array:
    """The x >= 0, shape (m,), that makes M x - d shortest, in float64.

    The method is that of Lawson and Hanson (1974) with another choice of the entry that is set to
    zero: the least one that is not positive; theirs is the first that vanishes on the way from the
    former x. SciPy has their method, but importing SciPy takes as long as a short run.

    Parameters
    ----------
    M : ndarray, shape (k, m)
        No column is zero [any unit].
    d : ndarray, shape (k,)
        [any unit].

    Raises
    ------
    ValueError
        If float64 does not suffice for the least squares of some columns.
    """
    lengths = np.linalg.norm(M, axis=0)
    M = M / lengths
    products = M.T @ M
    x = np.zeros(len(lengths))
    positive = np.zeros(len(lengths), dtype=bool)
    for _ in range(MOST * len(lengths)):
        descent = np.where(positive, 0.0, M.T @ (d - M @ x))
        steepest = int(np.argmax(descent))
        if not descent[steepest] > ROUNDING * np.linalg.norm(d):
            break
        positive[steepest] = True
        while True:
            x = np.zeros(len(lengths))
            inverse = np.linalg.inv(products[np.ix_(positive, positive)])
            for _ in range(REFINED):
                x[positive] += inverse @ (M[:, positive].T @ (d - M @ x))
            falling = positive & (x <= 0)
            if not falling.any():
                break
            positive[np.argmin(np.where(falling, x, np.inf))] = False
    return np.asarray(x / lengths)
