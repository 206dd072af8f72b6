"""Two bodies welded: no point of one moves relative to the other. Equations, certified exactly."""

from quasistatic_ref.step.extension import Extension


def weld(J_1, J_2):
    """J_1, J_2 of shape (6, n_v): velocity at one point and spin of each body, world frame."""
    return Extension(lambda s: [(J_1 - J_2) @ s.delta_q == 0])
