"""The drag of small steps, and the boundary layer of large ones, on a block at one speed.

A plate on a spring pushes it; how far the plate lags behind its target measures the force. It is
friction, mu_v m g, and m v / h more: a block starts every step from rest. This drag grows as steps
shrink: over friction it is the quasi-dynamic number v / (mu_v g h). What grows with the step is the
boundary layer, mu_v h v, (R13).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY as G
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.step.data import Array

M = 0.5
"""Of the block [kg]."""
MU_V = 0.4
"""Of block and floor [-]."""
V = 0.01
"""Of the plate's target [m/s]."""
TIME_STEPS = tuple(np.geomspace(0.5e-3, 0.1, 6).tolist())
"""h [s]."""
K_Q = 1e7
"""So stiff that the lag is steady after few steps: it approaches by 1 / (1 + h^2 K_q / m) [N/m]."""
SETTINGS = (
    "steps=15",
    f"bodies.pusher.K_q.slide={K_Q}",
    "bodies.pusher.pose.xyz=[-0.06, 0, 0.05]",  # the plate touches the block
    f"bodies.pusher.targets=[{{t=0.0, slide=0.0}}, {{t=8.0, slide={8.0 * V}}}]",
)


def drag_and_layer(h: Sequence[float] = TIME_STEPS, mu_v: float = MU_V) -> tuple[Array, Array]:
    """Drag over friction [-] and boundary layer [m] of a steady push, each of shape (len(h),).

    Parameters
    ----------
    h : sequence of float
        Time steps, of 0.1 s at most [s].
    mu_v : float
        Of block and floor [-].
    """
    friction = mu_v * M * G
    shares = []
    layers = []
    for each in h:
        _, run = scenario_run("block_push", *SETTINGS, f"h={each}", f"contacts.floor.mu_v={mu_v}")
        force = K_Q * (run["q_bar_a"][-1, 0] - run["q"][-1, 0])
        shares.append(force / friction - 1)
        layers.append(run["phi"][-1, :4].max())
    return np.array(shares), np.array(layers)


def main() -> Numbers:
    """Both at the smallest and the largest step, and what (R13) says."""
    found: Numbers = {}
    for h, share, layer in zip(TIME_STEPS, *drag_and_layer(), strict=True):
        if h in (min(TIME_STEPS), max(TIME_STEPS)):
            at = f"at {1e3 * h:.3g} ms"
            found[f"drag over friction {at} [-]"] = share
            found[f"v / (mu_v g h) {at} [-]"] = V / (MU_V * G * h)
            found[f"boundary layer {at} [um]"] = 1e6 * layer
            found[f"mu_v h v {at} [um]"] = 1e6 * MU_V * h * V
    return found


def figure(ax: Any = None, *, h: Sequence[float] = TIME_STEPS, mu_v: float = MU_V) -> Figure:
    """Drag and boundary layer against h, next to the formulas.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    h : sequence of float
        Time steps, of 0.1 s at most [s].
    mu_v : float
        Of block and floor [-].
    """
    page, (left, right) = panels(6.3, 2.8, columns=2, within=ax)
    shares, layers = drag_and_layer(h, mu_v)
    ms = 1e3 * np.array(h)
    left.loglog(ms, shares, "o", label="runs")
    left.loglog(ms, 1e3 * V / (mu_v * G * ms), "k-", label=r"$v / (\mu_v g h)$")
    left.axhline(0.1, color="black", linestyle=":", label="a tenth")
    label_axes(left, "time step h [ms]", "drag over friction [-]", f"{1e3 * V:g} mm/s")
    right.loglog(ms, 1e6 * layers, "o", label="runs")
    right.loglog(ms, 1e3 * mu_v * V * ms, "k-", label=r"$\mu_v h v$")
    label_axes(right, "time step h [ms]", r"boundary layer [$\mu$m]", "friction pyramid")
    return page
