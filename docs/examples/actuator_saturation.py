"""Actuators that saturate: a Huber cost of slope tau_max in place of the quadratic of (1)."""

import cvxpy as cp

from quasistatic_ref.step.extension import Extension


def actuator_saturation(h, K, tau_max):
    """The time step h [s]; stiffness K, diagonal, and force limits tau_max, shapes (n_a,)."""

    def terms(s):
        pull = cp.multiply(K / tau_max, s.delta_q_a - s.delta_q_bar_a)  # force / tau_max
        return [h * (tau_max**2 / (2 * K)) @ cp.huber(pull, 1)]

    return Extension(terms, without_stiffness=True)
