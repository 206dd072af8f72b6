"""Correct digits of an answer to a step."""

import numpy as np

from quasistatic_ref.certify.norm import digits_of_error, energy_norm, error_length, single_loads
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form


def correct_digits(step: StepData, delta_q: Array, exact_delta_q: Array) -> float:
    """Correct digits of a displacement [-], 0 to 16.

    Parameters
    ----------
    step : StepData
        SI units.
    delta_q, exact_delta_q : ndarray, shape (n_v,)
        The answer, and the optimum [m, rad].
    """
    form = standard_form(step)
    norm = energy_norm(form.H)
    with np.errstate(over="ignore", invalid="ignore"):
        off = norm.of_displacement(delta_q - exact_delta_q)
    length = error_length(form.H, form.g, exact_delta_q, single_loads(step))
    return digits_of_error(off / length)
