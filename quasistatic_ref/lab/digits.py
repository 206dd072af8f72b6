"""Correct digits of an answer: of its displacement, its net impulse and its slacks."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.certify.digits import relative_digits
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form


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
