"""Coulomb's slip against that of the convex model: how far, and in which direction.

Coulomb's friction opposes the slip with mu_v m g, so that a point from rest slips along its push by
h^2 (F - mu_v m g) / m. The first step of the convex model also rises, which makes it shorter by
1 + mu_v^2, (R8); step after step the rise ends, and the slip becomes Coulomb's, along an axis of
the pyramid. Between the axes the pyramid turns it towards the diagonal.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers, script
from quasistatic_ref.lab.figures.labels import caption, labelled
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import point_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

M, MU_V, H, STEPS = 1.0, 0.5, 0.01, 40
PUSHES = np.linspace(0.0, 3.0, 13)
"""Over mu_v m g [-]."""
ANGLES = np.linspace(0.0, 90.0, 19)
"""Of the push from d1 [deg]."""


def slips(push: float, angle: float, mu_v: float, h: float, cone: str, steps: int) -> Array:
    """Slip along d1 and d2 of the last of some steps, shape (2,) [m].

    Parameters
    ----------
    push, angle : float
        Over mu_v m g [-]; from d1 [deg].
    mu_v, h : float
        [-], [s].
    cone : str
    steps : int
    """
    psi, F, phi = np.radians(angle), push * mu_v * M * GRAVITY, 0.0
    for _ in range(steps):
        force = (F * np.cos(psi), F * np.sin(psi), -M * GRAVITY)
        step = point_step(M, force, mu_v, phi, h).replace(cone=cone)
        slip = solve_step(step, fast=True).delta_q
        phi += float(slip[2])
    return slip[:2]


def main() -> Numbers:
    """Slips under twice the threshold along d1, each followed by its formula."""
    coulomb = H**2 * MU_V * GRAVITY
    return {
        "first slip [mm]": 1e3 * slips(2.0, 0.0, MU_V, H, "pyramid", 1)[0],
        "Coulomb's over 1 + mu_v^2 [mm]": 1e3 * coulomb / (1 + MU_V**2),
        "slip after 40 steps [mm]": 1e3 * slips(2.0, 0.0, MU_V, H, "pyramid", STEPS)[0],
        "Coulomb's [mm]": 1e3 * coulomb,
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H, share: float = 2.0) -> Figure:
    """Slip against push along d1; direction of the first slip against that of the push.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        [-], [s].
    share : float
        Of the push whose direction is varied, over mu_v m g [-].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    coulomb = h**2 * mu_v * GRAVITY * np.maximum(PUSHES - 1, 0)
    left.plot(PUSHES, 1e3 * coulomb, label="Coulomb")
    for steps, mark in ((1, "o"), (STEPS, "^")):
        found = [1e3 * slips(push, 0.0, mu_v, h, "pyramid", steps)[0] for push in PUSHES]
        label = "first step" if steps == 1 else f"step {steps}"
        left.plot(PUSHES, found, mark, color="black", markerfacecolor="none", label=label)
    labelled(left, r"push along $d_1$ / ($\mu_v m g$) [-]", "slip of a step [mm]", caption(h))
    right.plot(ANGLES, ANGLES, label="Coulomb")
    for cone in ("pyramid", "facets-8"):
        found = [slips(share, angle, mu_v, h, cone, 1) for angle in ANGLES]
        right.plot(ANGLES, [np.degrees(np.arctan2(y, x)) for x, y in found], label=cone)
    right.set(xticks=range(0, 91, 30), yticks=range(0, 91, 30))
    labelled(right, r"push from $d_1$ [deg]", r"slip from $d_1$ [deg]", f"{share:g} $\\mu_v m g$")
    return page


if __name__ == "__main__":
    script(main, figure)
