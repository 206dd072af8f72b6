"""A plate on a spring pushes a block over the floor: friction, and the model's own drag.

The lag of the plate behind its target measures the force. It is mu_v m g, and m v / h more: a
block starts every step from rest. The drag is small where the quasi-dynamic number v / (mu_v g h)
is; here it is a quarter of friction, on purpose.
"""

from typing import Any

from quasistatic_ref.lab.examples.shared import Numbers, script
from quasistatic_ref.lab.figures.labels import caption, labelled
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

M, MU_V, K_Q, V, G = 0.5, 0.4, 1000.0, 0.01, 9.81
H, TIME = 0.01, 1.2
"""Time step and length of the run [s]."""


def pushed(mu_v: float = MU_V, h: float = H) -> tuple[Scenario, Trajectory, Array]:
    """The scene, its run of 1.2 s, and the force of the spring after each step, shape (N,) [N]."""
    settings = f"h={h}", f"steps={round(TIME / h)}", f"contacts.floor.mu_v={mu_v}"
    scenario, run = ran("block_push", *settings)
    return scenario, run, K_Q * (run["q_bar_a"][:, 0] - run["q"][1:, 0])


def main() -> Numbers:
    """The push at the end, and what it should be."""
    scenario, run, force = pushed()
    return {
        "push [N]": force[-1],
        "friction mu_v m g [N]": MU_V * M * G,
        "drag m v / h [N]": M * V / scenario.h,
        "quasi-dynamic number [-]": run.header["quasi_dynamic_number"],
        "boundary layer [um]": 1e6 * run["phi"][-1, :4].max(),
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H) -> Figure:
    """The block under way, and the push against time.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        [-], [s].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    scenario, run, force = pushed(mu_v, h)
    draw_scene(left, moment(scenario, run, -1), view="xz", parts=("contacts", "cones", "forces"))
    right.plot(run["t"], force, label="spring")
    friction, drag = mu_v * M * G, M * V / h
    right.axhline(friction, color="black", linestyle=":", label=r"$\mu_v m g$")
    right.axhline(friction + drag, color="black", linestyle="--", label=r"$\mu_v m g + m v / h$")
    labelled(right, "time t [s]", "push [N]", caption(h))
    return page


if __name__ == "__main__":
    script(main, figure)
