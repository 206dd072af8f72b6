"""Figure 3 of the paper: the boundary layer of a sphere spun on the floor."""

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from quasistatic_ref.figures.style import figure_style, sized
from quasistatic_ref.simulate.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory


def boundary_layer(scenario: Scenario, run: Trajectory, height_at_rest: float) -> Figure:
    """Spin rate and lift-off against the applied torque.

    Parameters
    ----------
    scenario : Scenario
        ``sphere_spin``, or one like it: one free sphere, a torque about the vertical.
    run : Trajectory
    height_at_rest : float
        Height of the centre when the sphere touches the floor [m].
    """
    (wrenches,) = scenario.wrenches
    torque = np.interp(run["t"], wrenches.times, wrenches.values[:, 5])
    spin = run["delta_q"][:, 5] / scenario.h
    lift = run["q"][1:, 2] - height_at_rest
    mu_omega = float(run["mu_omega"][0])
    limit = mu_omega * scenario.system.mass("sphere") * -float(scenario.gravity[2])
    with figure_style():
        figure, (top, bottom) = plt.subplots(2, 1, figsize=sized(4.6, 3.8), sharex=True)
        top.plot(1e3 * torque, spin)
        top.set_ylabel("spin rate [rad/s]")
        bottom.plot(1e3 * torque, 1e3 * lift)
        bottom.set(ylabel="lift-off [mm]", xlabel="applied torque [mN m]")
        for axes in (top, bottom):
            axes.axvline(1e3 * limit, color="black", linestyle=":", linewidth=1)
        top.annotate(
            r"$\mu_\omega\, m g$", (1e3 * limit, 0.9 * spin.max()), xytext=(-4, 0),
            textcoords="offset points", ha="right",
        )  # fmt: skip
        top.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    return figure
