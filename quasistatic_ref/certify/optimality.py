"""The optimality conditions (9)-(12) as residuals: an independent judge of any answer.

Nothing here knows which solver gave the answer, or by which interface it was called.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.step.arrays import largest
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form


@dataclass(frozen=True)
class Residuals:
    """Largest violation of each optimality condition, in the units of the step judged.

    Parameters
    ----------
    stationarity : float
        Eq. :eq:`eq-9`, as mended: H delta_q - g - sum_j A_j' lam_j = 0 [N s, N m s].
    primal : float
        Eq. :eq:`eq-10`: A delta_q >= b [m].
    dual : float
        Eq. :eq:`eq-11`: lam >= 0 [N s].
    complementarity : float
        Eq. :eq:`eq-12`: (A delta_q - b) o lam = 0 [N m s].
    """

    stationarity: float
    primal: float
    dual: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The largest of the four, NaN if any of them is: for a step in natural units [-]."""
        return largest(np.array([*vars(self).values()]))


def residuals_of(balance: Array, short: Array, pull: Array, work: Array) -> Residuals:
    """The largest violations among those of every coordinate and row.

    Parameters
    ----------
    balance : ndarray, shape (n_v,)
        Impulses that are not balanced [N s, N m s].
    short, pull : ndarray, shape (m,)
        How far each row is violated [m], and how far its multiplier is below 0 [N s]; negative
        where the condition holds.
    work : ndarray, shape (m,)
        Slack times multiplier [N m s].
    """
    sizes = np.abs(balance), short, pull, np.abs(work)
    return Residuals(*map(largest, sizes))


def optimality_residuals(form: StandardForm, delta_q: Array, lam: Array) -> Residuals:
    """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at an answer.

    Parameters
    ----------
    form : StandardForm
        The step's H, g, A and b, in SI or in natural units; H and A may be sparse.
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)
        Multipliers, contact-major, the user's own rows last.

    Returns
    -------
    Residuals
    """
    H, g, A, b = form
    balance = H @ delta_q - g - A.T @ lam  # Eq. (9), as (13) has it
    slack = A @ delta_q - b
    short = -slack  # Eq. (10): slack >= 0
    pull = -lam  # Eq. (11): lam >= 0
    work = slack * lam  # Eq. (12): zero, row by row
    return residuals_of(balance, short, pull, work)


def ellipsoid_residuals(step: StepData, delta_q: Array, lam: Array) -> Residuals:
    """The same at an answer of a step in the ellipsoid.

    There s = A delta_q - b is each contact's motion (n, d1, d2, spin), and lam its impulse. For
    each contact (10) reads s_n >= ||mu o s_t||, (11) lam_n >= ||lam_t / mu||, (12) lam^T s = 0.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)

    Returns
    -------
    Residuals
    """
    form, k = standard_form(step), int(step.offsets[-1])
    balance = form.H @ delta_q - form.g - form.A.T @ lam  # Eq. (9), mended
    slack = form.A @ delta_q - form.b
    s, f, mu = slack[:k].reshape(-1, 4), lam[:k].reshape(-1, 4), step.contacts.mu
    scaled = np.divide(f[:, 1:], mu, out=np.zeros_like(mu), where=mu > 0)
    without = np.abs(np.where(mu > 0, 0.0, f[:, 1:]))  # a force that has no coefficient
    short = np.concatenate([np.linalg.norm(mu * s[:, 1:], axis=1) - s[:, 0], -slack[k:]])
    pulls = np.concatenate([np.linalg.norm(scaled, axis=1) - f[:, 0], without.ravel(), -lam[k:]])
    work = np.concatenate([np.sum(s * f, axis=1), slack[k:] * lam[k:]])
    return residuals_of(balance, short, pulls, work)  # Eqs. (9)-(12)
