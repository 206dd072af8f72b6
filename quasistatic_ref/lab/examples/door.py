"""A door on a passive hinge, pushed open by a round tip that moves straight on, and stops.

The hinge is a coordinate that nothing drives: M_u is one number, its inertia. The door is where the
tip puts it, and stays there when the tip stops, since no velocity is carried from step to step.
"""

import numpy as np

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.step.data import Array

R, W = 0.6, 0.045
"""The tip's distance beside the hinge; its radius and half of the door's thickness [m]."""

SETTINGS = ("h=0.04", "steps=120")


def place(theta: Array) -> Array:
    """Where a tip that touches the door is, x = r tan(theta) - w / cos(theta), of its shape [m]."""
    return np.asarray(R * np.tan(theta) - W / np.cos(theta))


def main() -> Numbers:
    """The angle at the end, how far the tip is from where geometry has it, and the last motion."""
    _, run = ran("door", *SETTINGS)
    x, theta = run["q"][1:].T
    return {
        "angle at the end [deg]": np.degrees(theta[-1]),
        "tip's distance from x(theta) at the end [um]": 1e6 * abs(x[-1] - place(theta[-1:])[0]),
        "turn in the last step [rad]": abs(run["delta_q"][-1, 1]),
    }


@styled
def figure() -> Figure:
    """The door from above, and its angle against the place of the tip."""
    page, (left, right) = panels(6.3, 3.0, columns=2)
    scenario, run = ran("door", *SETTINGS)
    draw_scene(left, moment(scenario, run, 75), view="xy")
    x, theta = run["q"][1:].T
    right.plot(1e3 * x, np.degrees(theta), label="steps")
    touching = np.linspace(theta.min(), theta.max(), 50)
    label = r"$x = r \tan\theta - w / \cos\theta$"
    right.plot(1e3 * place(touching), np.degrees(touching), "k:", label=label)
    right.set(xlabel="place x of the tip [mm]", ylabel=r"angle $\theta$ of the door [deg]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, frictionless", loc="right")
    right.legend()
    return page


if __name__ == "__main__":
    script(main, figure)
