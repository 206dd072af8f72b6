"""After Figure 3 of the paper: a sphere on the floor, spun by a torque that grows.

Up to mu_omega m g it does not move at all. Beyond, it turns, and lifts off: a turn of theta needs
a rise of mu_omega theta. This boundary layer is the price of convexity.
"""

from __future__ import annotations

import numpy as np

from quasistatic_ref.figures import Figure, styled
from quasistatic_ref.figures import boundary_layer as drawing
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran

RADIUS, MU_OMEGA, M, G = 0.05, 0.01, 0.3, 9.81


def main() -> Numbers:
    """Where it begins to move, and how high it has risen at five times that torque."""
    scenario, run = ran("sphere_spin")
    (wrenches,) = scenario.wrenches
    torque = np.interp(run["t"], wrenches.times, wrenches.values[:, 5])
    moves = np.abs(run["delta_q"]).max(axis=1) > 1e-12
    return {
        "largest torque without motion [mN m]": 1e3 * torque[~moves].max(),
        "mu_omega m g [mN m]": 1e3 * MU_OMEGA * M * G,
        "spin at the end [rad/s]": run["delta_q"][-1, 5] / scenario.h,
        "lift-off at the end [mm]": 1e3 * (run["q"][-1, 2] - RADIUS),
    }


@styled
def figure() -> Figure:
    """Spin and lift-off against the torque."""
    scenario, run = ran("sphere_spin")
    return drawing.boundary_layer(scenario, run, height_at_rest=RADIUS)


if __name__ == "__main__":
    script(main, figure)
