"""A section of three friction cones: the torque that a contact bears with a sideways force.

At a normal force of 1 N and f_2 = 0: the octahedron of the six rows is a square on its corner here,
for f_1 and the torque share the normal force, (R9); the ellipsoid is a circle; in the product each
has all of it. Marks are steps of the program with a sphere that is loaded so: it is held, to the
last bit, or it slips.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import labelled
from quasistatic_ref.lab.measures import threshold
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step

MU_V = 0.5
MU_OMEGA = 0.02
H = 0.01
STILL = 1e-12
"""A motion below this [m, rad] is none: an enclosure of the ellipsoid leaves 1e-18."""
PRECISION = 1e-6
LOADS = np.linspace(0.0, 1.2, 9)
"""Along each axis, of what the contact bears at most [-]; none lies on an edge of the pyramid."""


def holds(f_1: float, tau_n: float, cone: str, mu_v: float, mu_omega: float) -> bool:
    """Whether a sphere under 1 N stays.

    Parameters
    ----------
    f_1, tau_n : float
        Sideways force over mu_v f_n, torque about the normal over mu_omega f_n [-].
    cone : str
    mu_v, mu_omega : float
        [-], [m].
    """
    wrench = (mu_v * f_1, 0.0, -1.0, 0.0, 0.0, mu_omega * tau_n)
    step = sphere_step(0.1, 1e-4, 0.0, wrench, mu_v=mu_v, mu_omega=mu_omega, phi=0.0, h=H)
    answer = solve_step(step.replace(cone=cone), fast=True)
    return bool(np.abs(answer.delta_q).max() < STILL)


def largest_torque(f_1: float, cone: str) -> float:
    """The torque over mu_omega f_n [-] from which on a sphere slips, by bisection on steps.

    Parameters
    ----------
    f_1 : float
        Over mu_v f_n [-].
    cone : str
    """

    def slips(tau_n: float) -> bool:
        return not holds(f_1, tau_n, cone, MU_V, MU_OMEGA)

    return threshold(slips, 0.1, 1.5, PRECISION)


def main() -> Numbers:
    """The largest torque with half of the largest force, each followed by its formula."""
    formulas = {"pyramid": 1 - 0.5, "ellipsoid": float(np.sqrt(1 - 0.5**2)), "product": 1.0}
    found: Numbers = {}
    for cone, formula in formulas.items():
        found[f"torque with half of the force, {cone} [-]"] = largest_torque(0.5, cone)
        found[f"by its section, {cone} [-]"] = formula
    return found


def figure(ax: Any = None, *, mu_v: float = MU_V, mu_omega: float = MU_OMEGA) -> Figure:
    """The three sections, and steps of the program in the pyramid.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, mu_omega : float
        [-], [m].
    """
    page, (axes,) = panels(4.6, 3.8, within=ax)
    angle = np.linspace(0, 2 * np.pi, 200)
    outlines = {
        "pyramid": ([1, 0, -1, 0, 1], [0, 1, 0, -1, 0]),
        "ellipsoid": (np.cos(angle), np.sin(angle)),
        "product": ([1, 1, -1, -1, 1], [-1, 1, 1, -1, -1]),
    }
    for cone, outline in outlines.items():
        axes.plot(*outline, label=cone)
    f_1, tau = (load.ravel() for load in np.meshgrid(LOADS, LOADS))
    still = np.array(
        [holds(f, t, "pyramid", mu_v, mu_omega) for f, t in zip(f_1, tau, strict=True)]
    )
    pen: dict[str, Any] = {"linestyle": "none", "color": "black", "markersize": scaled(3)}
    axes.plot(f_1[still], tau[still], "s", label="step, held", **pen)
    axes.plot(f_1[~still], tau[~still], "o", fillstyle="none", label="step, slips", **pen)
    axes.set(aspect="equal", xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    labelled(axes, r"$f_1 / (\mu_v f_n)$ [-]", r"$\tau_n / (\mu_\omega f_n)$ [-]")
    return page
