"""A sphere spun about the normal of the floor, at a torque or at a rate, until its gap settles."""

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import GRAVITY, contacts_of
from quasistatic_ref.lab.made_steps.rigid import sphere_step
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.step.data import StepData

M, INERTIA, RADIUS, MU_V, MU_OMEGA = 0.3, 8e-5, 0.05, 1.0, 0.01
"""As in models/sphere_spin."""
LIMIT = MU_OMEGA * M * GRAVITY

SPIN, STIFFNESS = 2.0, 1000.0
"""Imposed spin rate [rad/s], through an impedance [N m/rad]."""

SETTLED = 40
"""Steps until the gap no longer changes: the transient loses a factor of three at least in each."""


def layer_at_torque(h: float, tau: float) -> float:
    """The gap at which a sphere settles that a fixed torque spins [m]."""
    phi = 0.0
    for _ in range(SETTLED):
        wrench = (0, 0, -M * GRAVITY, 0, 0, tau)
        step = sphere_step(M, INERTIA, RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=phi, h=h)
        phi += float(exact(step).delta_q[2])
    return phi


def spun_step(phi: float, lag: float, h: float) -> StepData:
    """A sphere whose turn is actuated, its target `lag` [rad] ahead; q_u is its centre."""
    J = np.zeros((1, 4, 4))
    J[0, :3, 1:], J[0, 3, 0] = np.eye(3), 1.0
    return StepData(
        h, [[STIFFNESS]], M * np.eye(3), np.zeros(1), [0, 0, -M * GRAVITY],
        [lag + SPIN * h], contacts_of(phi, np.eye(3), J, MU_V, MU_OMEGA, rows=6),
    )  # fmt: skip


def layer_at_rate(h: float) -> float:
    """The gap at which a sphere settles that spins at an imposed rate [m]."""
    phi = 0.0
    lag = 0.0
    for _ in range(SETTLED):
        turn, _, _, rise = exact(spun_step(phi, lag, h)).delta_q
        lag = lag + SPIN * h - float(turn)
        phi = phi + float(rise)
    return phi
