"""One contact loaded with a force and a torque at once."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.measures import exact, threshold
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
INERTIA = 3e-4
MU_V = 0.4
MU_OMEGA = 0.015
RADIUS = 1 / 16
"""A power of two: the torque of the force, were it rounded, would make the sphere roll [m]."""


def evidence() -> Evidence:
    """Random directions of (f_1, f_2, tau_n) at the contact point, scaled until something moves."""
    rng = np.random.default_rng(3)
    N = M * GRAVITY
    found = []
    expected = []
    for direction in rng.normal(size=(24, 3)):
        f1, f2, tau = direction * [MU_V * N, MU_V * N, MU_OMEGA * N]

        def moves(share: float, f1: float = f1, f2: float = f2, tau: float = tau) -> bool:
            # At the contact point, a radius below the centre: (0, 0, -r) x f.
            wrench = share * np.array([f1, f2, 0, RADIUS * f2, -RADIUS * f1, tau])
            wrench[2] = -N
            step = sphere_step(
                M, INERTIA, RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=0.0, h=0.01
            )
            return bool(np.any(exact(step).delta_q))

        limit = 1 / np.abs(direction).sum()
        found.append(threshold(moves, 0.1 * limit, 3 * limit) / limit)
        expected.append(1.0)
    return Evidence.of(
        comparison("load that moves it, over the limit [-]", found, expected, CLOSED_FORM)
    )


CLAIM = Claim(
    name="octahedron",
    sentence="Tangential and torsional friction share one normal force: |f_1|/mu_v + |f_2|/mu_v + "
    "|tau_n|/mu_omega <= f_n.",
    where="docs/derivations.md (R9); the paper, Eqs. (4)-(7)",
    sweep="24 random directions of (f_1, f_2, tau_n); each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=evidence,
)
