"""Dry friction in the joints: a private rise lies on each, pressed down by tau_f, (R60)."""

from quasistatic_ref.step.extension import Extension, Rises


def dry_friction(h, K, tau_f):
    """The time step h [s]; stiffness K, diagonal, and friction tau_f, shapes (n_a,) [N, N m]."""
    masses = 1e-6 * h**2 * K  # small against that of h K delta_q
    return Extension(rises=Rises(tau_f, masses, coordinates=range(len(K))))
