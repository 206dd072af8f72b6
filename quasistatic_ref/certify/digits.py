r"""The one definition of error, and correct digits of any answer.

.. math:: \mathrm{error} = \frac{\|x - x^*\|_H}{\|H^{-1} g\|_H}, \qquad
          \mathrm{digits} = -\log_{10} \mathrm{error} \text{, clipped to } 0 \ldots 16,

with ||v||_H^2 = v'Hv; if g = 0, digits are 16 where x = x* and 0 elsewhere. Net impulses and
slacks are measured as the displacements that they stand for, so that the three can be compared:

- net impulse p = A'lam by the displacement H^-1 p that it causes:
  ||p - p*||_{H^-1} / ||H^-1 g||_H, with ||p||_{H^-1} = ||H^-1 p||_H;
- slack of row i by the shortest displacement that changes it so much:
  max_i |a_i'(x - x*)| / ||a_i||_{H^-1} / ||H^-1 g||_H, never more than the error of x.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

MOST = 16.0
"""Digits of a float64: more cannot be known."""


@dataclass(frozen=True)
class Digits:
    """Correct digits of an answer, 0 to 16.

    Parameters
    ----------
    delta_q : float
        Of the displacement.
    net_impulse : float or None
        Of the net impulse A'lam [-]; None if the answer has no multipliers.
    slack : float
        Of the worst slack.
    """

    delta_q: float
    net_impulse: float | None
    slack: float


def digits_of_error(error: float) -> float:
    """-log10 of a relative error [-], clipped to 0 .. 16; 0 for NaN.

    Examples
    --------
    >>> digits_of_error(1e-9), digits_of_error(0.0), digits_of_error(3.0)
    (9.0, 16.0, 0.0)
    """
    if not error < 1:
        return 0.0
    return min(MOST, float(-np.log10(error))) if error > 0 else MOST


def correct_digits(
    step: StepData,
    delta_q: Array,
    exact_delta_q: Array,
    lam: Array | None = None,
    exact_net: Array | None = None,
) -> Digits:
    """Correct digits of an answer to a step.

    Parameters
    ----------
    step : StepData
        SI units.
    delta_q : ndarray, shape (n_v,)
        The answer.
    exact_delta_q : ndarray, shape (n_v,)
        The optimum [m, rad].
    lam : ndarray, shape (m,), optional
        The answer's multipliers, the user's own rows last.
    exact_net : ndarray, shape (n_v,), optional
        A'lam of the optimum [N s, N m s]; needed with `lam`.

    Returns
    -------
    Digits
    """
    form = standard_form(step)
    norm = energy_norm(form.H)
    with np.errstate(over="ignore", invalid="ignore"):
        off = delta_q - exact_delta_q
        unconstrained = norm.impulse(form.g)
        net_impulse = None
        if lam is not None and exact_net is not None:
            net_off = form.A.T @ lam - exact_net
            net_impulse = relative_digits(norm.impulse(net_off), unconstrained)
        reach = norm.impulses(form.A)
        slack_off = np.abs(form.A @ off)[reach > 0] / reach[reach > 0]
        return Digits(
            delta_q=relative_digits(norm.displacement(off), unconstrained),
            net_impulse=net_impulse,
            slack=relative_digits(float(slack_off.max(initial=0.0)), unconstrained),
        )


def relative_digits(off: float, unconstrained: float) -> float:
    """Correct digits, 0 to 16 [-], of what is `off` where ||H^-1 g||_H is `unconstrained`."""
    if unconstrained == 0:
        return MOST if off == 0 else 0.0
    return digits_of_error(off / unconstrained)
