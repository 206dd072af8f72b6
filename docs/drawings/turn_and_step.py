"""How far the bunny turns in the hand against mu_omega, for three time steps.

Drag, m v / h, adds to the weight while the gripper lifts. So the mu_omega from which on the grip
holds the bunny depends on the time step.
"""

from functools import cache

import numpy as np

from quasistatic_ref import load_scenario, relative_turn
from quasistatic_ref.lab.figures.labels import label_axes, legend_below
from quasistatic_ref.lab.grasp import CLOSED
from quasistatic_ref.optional.show.figures import Figure, panels

MU_OMEGA = np.array([1.0, 1.2, 1.3, 1.4, 1.45, 1.5, 1.55, 1.6, 1.7, 1.8, 2.0, 2.1, 2.2, 2.4])  # mm
MASS, GRAVITY, SPEED = 0.2, 9.81, 0.01818  # of the bunny and of the lift [kg, m/s^2, m/s]
END = 2.9  # of the lift [s]
WITHOUT_DRAG = 1.42  # the threshold by (R14) from the forces of one step [mm], exercise 6
STEPS = {0.005: "-o", 0.01: "--s", 0.05: ":^"}
"""Each h [s], with the look of its line."""


@cache
def turn(mu_omega: float, h: float) -> float:
    """The bunny's largest turn in the hand while it is lifted [deg]; mu_omega in mm."""
    changes = {"contacts.grip.mu_omega": 1e-3 * mu_omega, "h": h, "solver.certify": "off"}
    scenario = load_scenario("bunny_grasp", changes, steps=round(END / h), fast=True)
    run = scenario.run(progress=False, findings=False)
    turns = relative_turn(scenario.system, run, "bunny", "gripper", since=CLOSED)
    return float(np.degrees(turns[np.append(0, run.t) >= CLOSED].max()))


def figure() -> Figure:
    """One line for each h; the threshold without drag as a grey line."""
    page, (axes,) = panels(5.2, 3.2)
    axes.axvline(WITHOUT_DRAG, color="0.6", linewidth=3, label="enough without drag")
    for h, look in STEPS.items():
        turns = [turn(float(mu_omega), h) for mu_omega in MU_OMEGA]
        drag = SPEED / (GRAVITY * h)
        label = f"h = {1e3 * h:g} ms, drag {drag:.2f} of the weight"
        axes.plot(MU_OMEGA, turns, look, color="black", markerfacecolor="none", label=label)
    label_axes(axes, r"$\mu_\omega$ of the fingers [mm]", "turn in the hand [deg]", key=False)
    legend_below([axes], axes.get_legend_handles_labels()[0])
    return page
