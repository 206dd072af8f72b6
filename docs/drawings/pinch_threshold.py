"""Two fingers hold a bar off its centre of mass: how hard they have to press.

With torsional friction the bar's weight m g has a lever d that the fingers can resist. In the
paper's pyramid the normal force is shared: N = m g / (2 mu_v) + m g d / (2 mu_omega), (R21).
"""

from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.lab.figures.labels import label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.thresholds import threshold
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

M = 0.2
MU_V = 0.5
MU_OMEGA = 0.02
D = 0.03
PRECISION = 1e-6
STILL = 1e-12
"""Motion below this [m, rad] is none: answers are exact, or enclosed to 1e-18 of a millimetre."""

SHARES = (0.97, 1.03)
"""Of the least squeeze: one slips, the other holds."""


def holds(
    cone: str, squeeze: float, d: float = D, m: float = M, mu_v: float = MU_V,
    mu_omega: float = MU_OMEGA,
) -> bool:  # fmt: skip
    """Whether one exact step leaves the bar where it is, at a squeeze [N] and a lever [m]."""
    step = pinch_step(squeeze, d, mu_v, mu_omega, m=m, cone=cone)
    motion = step.contacts.J @ solve_step(step, fast=True).delta_q
    return bool(np.abs(motion).max() < STILL)


def least_squeezes(
    d: Array, m: float = M, mu_v: float = MU_V, mu_omega: float = MU_OMEGA
) -> dict[str, Array]:
    """Cone -> the least squeeze that holds the bar [N], at levers [m]; shapes (N,)."""
    slide = m * GRAVITY / (2 * mu_v)
    spin = m * GRAVITY * d / (2 * mu_omega)
    return {
        "pyramid": slide + spin,  # (R21)
        "ellipsoid": np.hypot(slide, spin),  # (R22)
        "product": np.maximum(slide, spin),  # (R23)
    }


def main() -> dict[str, float]:
    """The least squeeze by bisection on steps, and in closed form."""
    least = least_squeezes(np.array([D]))
    return {
        "least squeeze, pyramid [N]": threshold(partial(holds, "pyramid"), 0.1, 100.0, PRECISION),
        "(R21) [N]": float(least["pyramid"][0]),
        "least squeeze, product [N]": threshold(partial(holds, "product"), 0.1, 100.0, PRECISION),
        "(R23) [N]": float(least["product"][0]),
    }


def figure(
    *, m: float = M, mu_v: float = MU_V, mu_omega: float = MU_OMEGA,
    levers: int = 5,
) -> Figure:  # fmt: skip
    """The least squeeze against the lever, in three cones: formulas, and steps as marks.

    Parameters
    ----------
    m, mu_v, mu_omega : float
        [kg], [-], [m].
    levers : int
        Number of levers at which steps are tried.
    """
    page, (axes,) = panels(4.8, 3.4)
    numbers = m, mu_v, mu_omega
    longest = 1.5 * mu_omega / mu_v
    dense = np.linspace(0.0, longest, 400)
    d = np.linspace(0.0, longest, levers)
    tried = least_squeezes(d, *numbers)
    marks: dict[str, Any] = {"color": "black", "markersize": scaled(4), "linestyle": ""}
    for name, least in least_squeezes(dense, *numbers).items():
        axes.plot(1e3 * dense, least, label=name)
        for share in SHARES:
            held = np.array([holds(name, share * N, x, *numbers) for N, x in
                             zip(tried[name], d, strict=True)])  # fmt: skip
            for said, mark, face in ((held, "^", "black"), (~held, "v", "none")):
                axes.plot(
                    1e3 * d[said], share * tried[name][said], mark, markerfacecolor=face, **marks
                )
    axes.plot([], [], "^", label="a step holds", **marks)
    axes.plot([], [], "v", markerfacecolor="none", label="a step slips", **marks)
    label_axes(axes, "lever d of the weight [mm]", "squeeze N [N]", "lines: (R21)-(R23)")
    return page
