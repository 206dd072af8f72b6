r"""Contact forces by compliance in the ellipsoid, enclosed in balls.

In the step with compliance c (:mod:`~quasistatic_ref.optional.forces.forces`) each contact gives
way by four lengths, s = c p. It is a conic program with compliant blocks
(:mod:`~quasistatic_ref.optional.ellipsoid.interior`), strongly convex in x and in s: any x and y
with A x - b + c y / h and y strictly inside of the cones give

.. math:: \tfrac12\|x - x^*\|_H^2 + \frac{c}{2h}\|y - y^*\|^2
          \le \tfrac12\|x - H^{-1}(g + A^T y)\|_H^2 + y^T (A x - b + c y / h).

Newton's method makes the right side 1e-60 of the step's energy.
"""

from typing import Final

import numpy as np
from flint import arb

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.enclosure import (
    BITS,
    checked,
    guesses,
    rounded,
    rounded_displacement,
)
from quasistatic_ref.optional.ellipsoid.scaled_blocks import scaled_blocks
from quasistatic_ref.optional.gap import square_root
from quasistatic_ref.step.data import StepData

P_OF_WRENCH: Final = [2, 0, 1, 3]
"""Where the parts of p stand in a wrench."""
WIDE: Final = arb(2) ** -180
"""Largest gap that is accepted, where the unconstrained step has length one."""


def compliant_forces(
    step: StepData, compliance: float, near: tuple[Array, Array]
) -> tuple[Array, Array]:
    """Contact forces of a step in the ellipsoid, and its displacement, with compliance.

    Parameters
    ----------
    step : StepData
    compliance : float
        Of each contact [m/N].
    near : (ndarray, ndarray)
        delta_q, shape (n_v,) [m, rad], and wrenches, shape (n_c, 4) [N, N m], of the step without
        compliance.

    Returns
    -------
    (ndarray, ndarray)
        (f_d1, f_d2, f_n, tau_n) of each contact, shape (n_c, 4) [N, N m], and delta_q, shape
        (n_v,), rounded from enclosures; 0.0 where an enclosure holds zero.

    Raises
    ------
    StepNotSolved
        If no enclosure is found.
    """
    n_c = step.contacts.n_c
    form = StepProgram(step)
    delta_q, wrench = near
    extra_lam = np.zeros(len(step.extra.b))
    start = delta_q, np.concatenate([(step.h * wrench[:, P_OF_WRENCH]).ravel(), extra_lam])
    with working_precision(BITS):
        frame = scaled_blocks(step, form, compliance)
        for pair, _ in guesses(frame, start):
            checked_pair = checked(frame, pair)
            if checked_pair is None or not checked_pair.gap <= WIDE * frame.size * frame.size:
                continue
            forces = np.zeros(4 * n_c)
            for i in range(4 * n_c):
                off = frame.mu[i] * square_root(2 * checked_pair.gap / frame.give[i])
                impulse = (checked_pair.y[i] + arb(0, off.upper())) / form.h
                forces[i] = rounded(impulse / step.h)
            x = rounded_displacement(frame, checked_pair)
            return forces.reshape(-1, 4)[:, np.argsort(P_OF_WRENCH)], x
    raise StepNotSolved("none", "no enclosure of the contact forces was found", step, 0.0)
