"""Joint limits: q_min <= q_a + delta_q_a <= q_max. Rows, hence certified exactly."""

from quasistatic_ref.step.extension import Extension


def joint_limits(q_a, q_min, q_max):
    """At q_a; all three of shape (n_a,) [m, rad]."""
    return Extension(lambda s: [s.delta_q_a >= q_min - q_a, s.delta_q_a <= q_max - q_a])
