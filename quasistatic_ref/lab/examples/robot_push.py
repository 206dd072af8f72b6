"""A real robot: a Franka Panda pushes a block over the floor, and its joints yield.

The robot comes as a URDF with the extra `robots`. Each joint is a spring whose target moves; how
far it stays behind is the torque that it bears. Friction and the model's drag push back with
F = mu_v m g + m v / h, and the sum of two joints' torques is F times the difference of their
heights.
"""

import numpy as np

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.step.data import Array

M, MU_V, K_Q, G = 0.4, 0.4, 7000.0, 9.81
SETTINGS = ("h=0.02", "steps=60")


def torques() -> tuple[Array, Array]:
    """tau_2 + tau_4 after each step, and F (z_4 - z_2) [N m], shapes (N,)."""
    scenario, run = ran("panda_push", *SETTINGS)
    system = scenario.system
    axes = [system.link(f"panda/panda_link{i}") for i in (2, 4)]
    z_2, z_4 = np.array([system.kinematics(q).t[axes, 2] for q in run["q"][:-1]]).T
    speed = run["delta_q"][:, system.joint("block/base").v][:, 0] / scenario.h
    force = np.where(speed > 0, MU_V * M * G, 0.0) + M * speed / scenario.h
    tau = K_Q * (run["q_bar_a"] - run["q"][1:, : system.n_q_a])[:, :7]
    return tau[:, 1] + tau[:, 3], force * (z_4 - z_2)


def main() -> Numbers:
    """The torques at the end, and how far the block went."""
    scenario, run = ran("panda_push", *SETTINGS)
    measured, formula = torques()
    x = run["q"][:, scenario.system.joint("block/base").q][:, 0]
    return {
        "tau_2 + tau_4 [N m]": measured[-1],
        "F (z_4 - z_2) [N m]": formula[-1],
        "way of the block [mm]": 1e3 * (x[-1] - x[0]),
    }


@styled
def figure() -> Figure:
    """The robot from the side, and the torques of two joints."""
    page, (left, right) = panels(6.3, 3.2, columns=2)
    scenario, run = ran("panda_push", *SETTINGS)
    draw_scene(left, moment(scenario, run, -1), view="xz", parts=("contacts", "forces"))
    measured, formula = torques()
    right.plot(run["t"], measured, label=r"$\tau_2 + \tau_4$")
    right.plot(run["t"], formula, color="black", linestyle=":", label=r"$F\,(z_4 - z_2)$")
    right.set(xlabel="time t [s]", ylabel="torque [N m]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    right.legend()
    return page


if __name__ == "__main__":
    script(main, figure)
