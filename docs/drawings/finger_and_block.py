"""A finger on a spring and a block on ice: where both start, and where a step takes them.

The numbers are those of lecture 3.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from quasistatic_ref import Contacts, StepData, solve_step
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

H, K_Q, MASS = 0.02, 500.0, 0.5  # s, N/m, kg
TARGET, PHI = 4e-3, 1e-3  # ahead of the finger, from finger to block [m]
FINGER, BLOCK = "#0072B2", "#E69F00"
WALL, BACK, FRONT = -9.0, -3.0, 0.0  # of the spring; of the finger [mm]


def step() -> StepData:
    """The step of lecture 3, delta_q = (finger, block)."""
    contact = Contacts(
        name=("finger/block",), phi=[PHI], n=[[1, 0, 0]], d1=[[0, 1, 0]], d2=[[0, 0, 1]],
        J=[[[-1, 1], [0, 0], [0, 0], [0, 0]]], mu_v=[0.0], mu_omega=[0.0], rows=[4],
    )  # fmt: skip
    return StepData(
        h=H, K_q=[[K_Q]], M_u=[[MASS]], tau_a=[0.0], tau_u=[0.0],
        delta_q_bar_a=[TARGET], contacts=contact,
    )  # fmt: skip


def _draw(axes: Axes, finger: float, block: float) -> None:
    """Wall, spring, finger, block and ice; displacements in mm."""
    axes.plot([WALL, WALL], [0, 4], color="0.3", linewidth=scaled(3))
    back = BACK + finger
    x = np.linspace(WALL, back, 200)
    coils = 0.6 * np.sin(np.linspace(0, 12 * np.pi, 200))
    axes.plot(x, 1.5 + coils, color="0.3", linestyle="-", linewidth=scaled(1))
    axes.add_patch(Rectangle((back, 0.5), FRONT - BACK, 2, facecolor=FINGER, alpha=0.6))
    axes.add_patch(Rectangle((1e3 * PHI + block, 0), 5, 3, facecolor=BLOCK, alpha=0.6))
    axes.plot([WALL, 11], [0, 0], color="0.6", linestyle="-", linewidth=scaled(1.5))
    axes.axvline(1e3 * TARGET, ymax=0.75, color=FINGER, linestyle=":", linewidth=scaled(1.2))
    axes.text(1e3 * TARGET, 4.4, "target", color=FINGER, ha="center")
    axes.set(xlim=(-9.6, 11), ylim=(-1.9, 5), xlabel="x [mm]", yticks=[])
    axes.grid(visible=False)


def _span(axes: Axes, ends: tuple[float, float], y: float, words: str) -> None:
    """A dimension line."""
    look = {"arrowstyle": "<|-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": scaled(0.8)}
    axes.annotate("", (ends[1], y), (ends[0], y), arrowprops=look | {"color": "black"})
    axes.text(sum(ends) / 2, y - 0.3, words, ha="center", va="top")


def figure() -> Figure:
    """Top, the start, with gap and target. Below, the end, with the force on both."""
    page, (start, end) = panels(6.3, 3.2, rows=2, sharex=True)
    solution = solve_step(step())
    finger, block = 1e3 * solution.delta_q
    _draw(start, 0.0, 0.0)
    _span(start, (0.0, 1e3 * PHI), 3.6, "")
    start.text(0.5, 3.8, r"$\phi$", ha="center")
    _span(start, (0.0, 1e3 * TARGET), -0.3, r"$\delta\bar q_a$")
    _draw(end, finger, block)
    _span(end, (0.0, finger), -0.3, r"$\delta q_a$")
    _span(end, (1e3 * PHI + 5, 1e3 * PHI + 5 + block), -0.3, r"$\delta q_u$")
    look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "color": "#D55E00"}
    touch = finger
    for way in (-1, 1):
        end.annotate(
            "", (touch + 2.6 * way, 1.5), (touch, 1.5), arrowprops=look | {"linewidth": scaled(2)}
        )
    end.text(touch + 5.2, 1.3, f"N = {solution.wrench[0, 2]:.2f} N", ha="left", va="center")
    start.set_xlabel("")
    for axes, words in ((start, "the step begins"), (end, "the step ends")):
        axes.set_title(words, loc="left")
    return page
