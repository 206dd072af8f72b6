"""Many runs at once: which mu_v and mu_omega let two fingers hold a bar off its centre of mass.

``two_finger_pinch`` with every combination of both coefficients of its first gripper; (R21) says
where the bar begins to slip at the fingers' 5 N.
"""

from collections.abc import Sequence
from functools import cache
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.sweep import simulate_many
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.step.data import Array, Mask

M = 0.2
"""Mass of the bar [kg]."""

D = 0.055
"""Its distance from the fingers [m]."""

N = 5.0
"""What they press with [N]."""

MU_V = np.linspace(0.2, 0.8, 13)
MU_OMEGA = np.linspace(0.0, 0.04, 9)
"""What is swept [-], [m]."""

STEPS = 5
STILL = 1e-9
"""Rotation [deg] and travel [mm] below this are none: every step is exact."""


def least_mu_omega(mu_v: Array) -> Array:
    """The least mu_omega that holds the bar, by (R21), shape (V,) [m]; infinite where none does."""
    left = N - M * GRAVITY / (2 * mu_v)  # what the squeeze leaves for torsion
    return np.divide(M * GRAVITY * D / 2, left, out=np.full_like(left, np.inf), where=left > 0)


@cache
def hold_mask(across: tuple[float, ...], up: tuple[float, ...]) -> Mask:
    """Whether the bar stays where it is, shape (V, W).

    Parameters
    ----------
    across, up : tuple of float
        mu_v [-], and mu_omega [m].
    """
    with TemporaryDirectory() as folder:
        rows = simulate_many(
            "two_finger_pinch",
            {"steps": [STEPS], "contacts.near.mu_v": across, "contacts.near.mu_omega": up},
            folder,
            progress=False,
        )
    moved = {
        (row["values"]["contacts.near.mu_v"], row["values"]["contacts.near.mu_omega"]): max(
            row["measures"]["held.largest_rotation_deg"],
            1e3 * row["measures"]["held.ends_from_start_m"],
        )
        for row in rows
    }
    return np.array([[moved[v, w] < STILL for w in up] for v in across])


def main() -> Numbers:
    """How many runs hold, how many (R21) says, and on how many of them the two differ."""
    expected = least_mu_omega(MU_V)[:, None] <= MU_OMEGA
    holds = hold_mask(tuple(MU_V.tolist()), tuple(MU_OMEGA.tolist()))
    return {
        "runs that hold [-]": float(holds.sum()),
        "(R21) [-]": float(expected.sum()),
        "runs that (R21) says otherwise of [-]": float((holds != expected).sum()),
    }


def figure(
    ax: Any = None, *, mu_v: Sequence[float] | None = None, mu_omega: Sequence[float] | None = None
) -> Figure:
    """Runs that hold and that slip, and the line between them.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, mu_omega : sequence of float, optional
        What is swept [-], [m].
    """
    across = MU_V if mu_v is None else np.array(mu_v)
    up = MU_OMEGA if mu_omega is None else np.array(mu_omega)
    holds = hold_mask(tuple(across.tolist()), tuple(up.tolist()))
    v, w = np.meshgrid(across, 1e3 * up, indexing="ij")
    line = np.linspace(across[0], across[-1], 200)
    least = least_mu_omega(line)
    page, (axes,) = panels(4.8, 3.6, within=ax)
    pen: dict[str, Any] = {"linestyle": "none", "color": "black", "markersize": scaled(3)}
    axes.plot(v[holds], w[holds], "s", label="holds", **pen)
    axes.plot(v[~holds], w[~holds], "o", label="slips", fillstyle="none", **pen)
    axes.plot(line[least <= up[-1]], 1e3 * least[least <= up[-1]], label="(R21)")
    label_axes(
        axes, r"$\mu_v$ [-]", r"$\mu_\omega$ [mm]", f"squeeze of {N:g} N, {1e3 * D:g} mm off"
    )
    return page
