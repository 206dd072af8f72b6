"""Many runs at once: which mu_v and mu_omega let two fingers hold a bar off its centre of mass.

``two_finger_pinch`` with every combination of both coefficients of its first gripper; (R21) says
where the bar begins to slip at the fingers' 5 N.
"""

from functools import cache
from tempfile import TemporaryDirectory

import numpy as np

from quasistatic_ref.figures import Figure, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.figures.study_sweep import hold_map
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.study.many import simulate_many
from quasistatic_ref.step.data import Array, Mask

M, D, N = 0.2, 0.055, 5.0
"""Mass of the bar [kg], its distance from the fingers [m], their squeeze [N]."""

MU_V, MU_OMEGA = np.linspace(0.2, 0.8, 21), np.linspace(0.0, 0.04, 17)
"""What is swept [-], [m]."""

STEPS = 5
STILL = 1e-9
"""Rotation [deg] and travel [mm] below this are none: every step is exact."""


def least_mu_omega(mu_v: Array) -> Array:
    """The least mu_omega (N,) [m] that holds the bar at mu_v (N,), shape (N,); infinite where none.

    By (R21).
    """
    left = N - M * GRAVITY / (2 * mu_v)  # what the squeeze leaves for torsion
    return np.divide(M * GRAVITY * D / 2, left, out=np.full_like(left, np.inf), where=left > 0)


@cache
def held() -> Mask:
    """Whether the bar stays where it is, shape (mu_v, mu_omega)."""
    with TemporaryDirectory() as folder:
        rows = simulate_many(
            "two_finger_pinch",
            {"steps": [STEPS], "contacts.near.mu_v": MU_V, "contacts.near.mu_omega": MU_OMEGA},
            folder,
            link="held",
            progress=False,
        )
    moved = {
        (row["values"]["contacts.near.mu_v"], row["values"]["contacts.near.mu_omega"]): max(
            row["measures"]["rotation_deg"], row["measures"]["travel_mm"]
        )
        for row in rows
    }
    return np.array([[moved[v, w] < STILL for w in MU_OMEGA.tolist()] for v in MU_V.tolist()])


def main() -> Numbers:
    """How many runs hold, how many (R21) says, and on how many of them the two differ."""
    expected = least_mu_omega(MU_V)[:, None] <= MU_OMEGA
    return {
        "runs that hold [-]": float(held().sum()),
        "(R21) [-]": float(expected.sum()),
        "runs that (R21) says otherwise of [-]": float((held() != expected).sum()),
    }


@styled
def figure() -> Figure:
    """Runs that hold and that slip, and the line between them."""
    line = np.linspace(MU_V[0], MU_V[-1], 200)
    return hold_map(MU_V, MU_OMEGA, held(), line, least_mu_omega(line))


if __name__ == "__main__":
    script(main, figure)
