"""How far the bunny turns in the hand against mu_omega, for three time steps, and why.

A part of the mu_omega that the grip needs bears the weight in a round cone, the ellipsoid. A second
part is needed because the pyramid is smaller. A third bears drag, m v / h, which adds to the weight
while the gripper lifts: this part depends on the time step.
"""

from functools import cache

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import load_scenario, relative_turn
from quasistatic_ref.lab.grasp import CLOSED
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

MU_OMEGA = np.array([1.0, 1.2, 1.3, 1.4, 1.45, 1.5, 1.55, 1.6, 1.7, 1.8, 2.0, 2.1, 2.2, 2.4])  # mm
MASS, GRAVITY, SPEED = 0.2, 9.81, 0.01818  # of the bunny and of the lift [kg, m/s^2, m/s]
END = 2.9  # of the lift [s]
MU_V = 0.6  # between bunny and fingers [-]
HELD = 137  # a step of the lift in which the grip holds the bunny
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


@cache
def thresholds() -> tuple[float, float, float]:
    """The mu_omega [mm] that the forces of one step of 10 ms need, (R9), as in exercise 6.

    For the weight alone in the ellipsoid and in the pyramid, and with drag in the pyramid. Both
    fingers' normals are along one line, so only the sum of the torques counts.
    """
    run = load_scenario("bunny_grasp", steps=HELD + 1, fast=True).run(
        progress=False, findings=False
    )
    wrenches = np.abs(run.step_forces(HELD)[run["rows"] == 6])
    loaded = wrenches[wrenches[:, 2] > 1e-6]
    weight = GRAVITY / (GRAVITY + SPEED / run.step_data(HELD).h)
    f_1, f_2, _, tau_n = weight * loaded.T
    f_n = loaded[:, 2]
    ellipsoid = tau_n.sum() / np.sqrt(f_n**2 - (f_1**2 + f_2**2) / MU_V**2).sum()

    def pyramid(share: float) -> float:
        f_1, f_2, _, tau_n = share * loaded.sum(axis=0)
        return float(tau_n / (f_n.sum() - (f_1 + f_2) / MU_V))

    return 1e3 * float(ellipsoid), 1e3 * pyramid(weight), 1e3 * pyramid(1.0)


def figure() -> Figure:
    """A bar of the parts of the threshold at 10 ms; below it one line for each h."""
    page, (bar, axes) = panels(5.6, 4.4, rows=2, sharex=True, height_ratios=[1, 4])
    ends = (0.0, *thresholds())
    parts = ("weight, in a round cone", "the pyramid", "drag")
    for left, right, name, colour in zip(
        ends, ends[1:], parts, ("0.8", "#56B4E9", "#D55E00"), strict=False
    ):
        bar.barh(
            0, right - left, left=left, height=0.5, color=colour, edgecolor="black", label=name
        )
        bar.text((left + right) / 2, 0, f"{right - left:.2f}", ha="center", va="center")
        axes.axvline(right, color="0.6", linewidth=scaled(1.0))
    bar.set(ylim=(-0.4, 0.4), yticks=[])
    bar.grid(visible=False)
    label_axes(bar)
    for h, look in STEPS.items():
        turns = [turn(float(mu_omega), h) for mu_omega in MU_OMEGA]
        drag = SPEED / (GRAVITY * h)
        label = f"h = {1e3 * h:g} ms, drag {drag:.2f} of the weight"
        axes.plot(MU_OMEGA, turns, look, color="black", markerfacecolor="none", label=label)
    axes.set_xlim(0, 2.5)
    label_axes(axes, r"$\mu_\omega$ of the fingers [mm]", "turn in the hand [deg]", key=False)
    legend_below([axes], axes.get_legend_handles_labels()[0])
    return page
