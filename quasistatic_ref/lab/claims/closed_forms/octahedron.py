"""One contact loaded with a force and a torque at once."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.lab.thresholds import thresholds
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
INERTIA = 3e-4
MU_V = 0.4
MU_OMEGA = 0.015
H = 0.01
RADIUS = 1 / 16
"""A power of two: the torque of the force, were it rounded, would make the sphere roll [m]."""


def _loaded_contact(share: float, phi: float, *direction: float) -> StepData:
    """A share of (f_1, f_2, tau_n), in units of what each alone holds, at the contact point."""
    N = M * GRAVITY - M * phi / H**2
    f1, f2, tau = share * np.array(direction) * [MU_V * N, MU_V * N, MU_OMEGA * N]
    # The point is a radius below the centre: (0, 0, -r) x f.
    wrench = (f1, f2, -M * GRAVITY, RADIUS * f2, -RADIUS * f1, tau)
    return sphere_step(M, INERTIA, RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=phi, h=H)


def evidence() -> Evidence:
    """Random directions and gaps; each direction is scaled until something moves."""
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(24, 3))
    gaps = H**2 * GRAVITY * rng.uniform(-1.0, 0.9, size=24)
    limits = 1 / np.abs(directions).sum(axis=1)
    sweep = np.column_stack([gaps, directions])
    along_floor = [0, 1, 5]  # x, y and the turn; z closes the gap at any load
    loads = thresholds(_loaded_contact, sweep, limits, (0.1, 3.0), along_floor)
    return Evidence.of(
        comparison("load that moves it, over the limit [-]", loads / limits, 1.0, CLOSED_FORM)
    )


CLAIM = Claim(
    name="octahedron",
    sentence="Tangential and torsional friction share one normal force: |f_1|/mu_v + |f_2|/mu_v + "
    "|tau_n|/mu_omega <= f_n.",
    where="docs/derivations.md (R9); the paper, Eqs. (4)-(7)",
    sweep="24 random directions of (f_1, f_2, tau_n), gaps from -1 to 1 mm; each threshold by "
    "bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=evidence,
)
