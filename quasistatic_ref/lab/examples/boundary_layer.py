"""After Figure 3 of the paper: a sphere on the floor, spun by a torque that grows.

Up to mu_omega m g it does not move at all. Beyond, it turns, and lifts off: a turn of theta needs
a rise of mu_omega theta. This boundary layer is the price of convexity.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers, script
from quasistatic_ref.lab.figures.labels import caption, labelled
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

RADIUS, MU_OMEGA, M, G, H = 0.05, 0.01, 0.3, 9.81, 0.01


def spun(mu_omega: float = MU_OMEGA, h: float = H) -> tuple[Scenario, Trajectory, Array]:
    """The scene, its run until the torque has its last value, whatever h is, and that torque.

    Parameters
    ----------
    mu_omega, h : float
        [m], [s].

    Returns
    -------
    tuple of Scenario, Trajectory and ndarray, shape (steps,)
        The torque of each step [N m].
    """
    scenario, run = ran("sphere_spin", f"h={h}", f"steps={round(2 / h)}",
                        f"contacts.floor.mu_omega={mu_omega}")  # fmt: skip
    (wrenches,) = scenario.wrenches
    return scenario, run, np.interp(run["t"], wrenches.times, wrenches.values[:, 5])


def main() -> Numbers:
    """Where it begins to move, and how high it has risen at five times that torque."""
    scenario, run, torque = spun()
    moves = np.abs(run["delta_q"]).max(axis=1) > 1e-12
    return {
        "largest torque without motion [mN m]": 1e3 * torque[~moves].max(),
        "mu_omega m g [mN m]": 1e3 * MU_OMEGA * M * G,
        "spin at the end [rad/s]": run["delta_q"][-1, 5] / scenario.h,
        "lift-off at the end [mm]": 1e3 * (run["q"][-1, 2] - RADIUS),
    }


def figure(ax: Any = None, *, mu_omega: float = MU_OMEGA, h: float = H) -> Figure:
    """Spin and lift-off against the torque.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_omega, h : float
        [m], [s].
    """
    page, (top, bottom) = panels(4.6, 3.8, rows=2, within=ax, sharex=True)
    scenario, run, torque = spun(mu_omega, h)
    limit = 1e3 * mu_omega * M * G
    top.plot(1e3 * torque, run["delta_q"][:, 5] / h)
    bottom.plot(1e3 * torque, 1e3 * (run["q"][1:, 2] - RADIUS))
    for axes in (top, bottom):
        axes.axvline(limit, color="black", linestyle=":", label=r"$\mu_\omega\,m g$")
    labelled(top, y="spin rate [rad/s]", title=caption(h, scenario.cone))
    labelled(bottom, "applied torque [mN m]", "lift-off [mm]", key=False)
    return page


if __name__ == "__main__":
    script(main, figure)
