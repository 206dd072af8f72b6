"""Dry friction in the joints: a cost h tau_f |delta_q_a|, whose slope is a force tau_f."""

import cvxpy as cp

from quasistatic_ref.step.extension import Extension


def dry_friction(h, tau_f):
    """The time step h [s]; friction forces tau_f of shape (n_a,) [N, N m]."""
    return Extension(lambda s: [h * tau_f @ cp.abs(s.delta_q_a)])
