"""A velocity limit: |delta_q_a| <= h v_max. Rows, hence certified exactly."""

from quasistatic_ref.step.extension import Extension


def velocity_limit(h, v_max):
    """The time step h [s]; v_max of shape (n_a,) or a number [m/s, rad/s]."""
    return Extension(lambda s: [s.delta_q_a <= h * v_max, s.delta_q_a >= -h * v_max])
