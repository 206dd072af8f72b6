"""After Figure 3 of the paper: a sphere on the floor, spun by a torque that grows.

Up to mu_omega m g it does not move at all. Beyond, it turns, and lifts off: a turn of theta needs
a rise of mu_omega theta. This boundary layer is the price of convexity. The paper calls it
proportional to h. That is right where the motion is imposed: mu_omega h omega. Under a given
torque, as in the paper's own experiment, the turn of a step is proportional to h^2, and so is the
layer.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.spun_sphere import (
    LIMIT,
    MU_OMEGA,
    RADIUS,
    M,
    layer_at_rate,
    layer_at_torque,
)
from quasistatic_ref.lab.thresholds import slope
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

H = 0.01
TIME_STEPS = tuple(np.geomspace(1e-3, 3e-2, 5).tolist())
"""h of the layers [s]."""
SHARE = 2.0
"""A fixed torque, over mu_omega m g [-]."""


def run_and_torques(mu_omega: float = MU_OMEGA, h: float = H) -> tuple[Trajectory, Array]:
    """The run until the torque has its last value, whatever h is; torques, shape (steps,) [N m].

    Parameters
    ----------
    mu_omega, h : float
        [m], [s].
    """
    scenario, run = scenario_run("sphere_spin", f"h={h}", f"steps={round(2 / h)}",
                        f"contacts.floor.mu_omega={mu_omega}")  # fmt: skip
    (wrenches,) = scenario.wrenches
    return run, np.interp(run["t"], wrenches.times, wrenches.values[:, 5])


@cache
def layers(sizes: tuple[float, ...] = TIME_STEPS, share: float = SHARE) -> dict[str, Array]:
    """The layer that a sphere settles on, one number for each time step, shape (N,) [m].

    Parameters
    ----------
    sizes : tuple of float
        Time steps [s].
    share : float
        Of the fixed torque over mu_omega m g [-].
    """
    return {
        "at_rate": np.array([layer_at_rate(h) for h in sizes]),
        "at_torque": np.array([layer_at_torque(h, share * LIMIT) for h in sizes]),
    }


def main() -> dict[str, float]:
    """Where it begins to move, how high it rises at five times that torque, exponents of h."""
    run, torque = run_and_torques()
    moves = np.abs(run["delta_q"]).max(axis=1) > 1e-12
    return {
        "largest torque without motion [mN m]": 1e3 * torque[~moves].max(),
        "mu_omega m g [mN m]": 1e3 * LIMIT,
        "spin at the end [rad/s]": run["delta_q"][-1, 5] / H,
        "lift-off at the end [mm]": 1e3 * (run["q"][-1, 2] - RADIUS),
        "exponent of h at a fixed rate [-]": slope(TIME_STEPS, layers()["at_rate"]),
        "exponent of h at a fixed torque [-]": slope(TIME_STEPS, layers()["at_torque"]),
    }


def figure(
    *, mu_omega: float = MU_OMEGA, h: float = H,
    sizes: Sequence[float] = TIME_STEPS, share: float = SHARE,
) -> Figure:  # fmt: skip
    """Lift-off against the torque, and the layer against the time step by both laws.

    Parameters
    ----------
    mu_omega, h : float
        Of the sphere whose torque grows [m], [s].
    sizes : sequence of float
        Time steps of the layers [s].
    share : float
        Of the fixed torque over mu_omega m g [-].
    """
    run, torque = run_and_torques(mu_omega, h)
    page, (left, right) = panels(6.3, 2.8, columns=2)
    left.plot(1e3 * torque, 1e3 * (run["q"][1:, 2] - RADIUS))
    limit = 1e3 * mu_omega * M * GRAVITY
    left.axvline(limit, color="black", linewidth=1, linestyle=":")
    left.annotate(
        r"$\mu_\omega\,m\,g$", (limit, 0.6), xycoords=("data", "axes fraction"),
        xytext=(-4, 0), textcoords="offset points", ha="right",
    )  # fmt: skip
    label_axes(left, "applied torque [mN m]", "lift-off [mm]", caption(h))
    found = layers(tuple(sizes), share)
    times = 1e3 * np.array(sizes)
    right.loglog(times, 1e6 * found["at_rate"], marker="o", label="fixed rate: slope 1")
    right.loglog(times, 1e6 * found["at_torque"], marker="s", label="fixed torque: slope 2")
    label_axes(right, "time step h [ms]", r"boundary layer [$\mu$m]", "friction pyramid")
    return page
