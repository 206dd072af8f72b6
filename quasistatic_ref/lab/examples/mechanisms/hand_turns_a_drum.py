"""A hand turns an object: three fingers of an Allegro hand roll on a drum and turn it.

The drum's axle is not driven. The middle fingertip, a sphere, rolls without slipping; then the
drum's angle theta obeys R theta = (R + rho) gamma - rho psi, gamma being the angle of the tip about
the axle and psi the turn of its link. The hand comes with the extra `robots`.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.cached_runs import scenario_run
from quasistatic_ref.lab.examples.shared import Numbers, only
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.optional.show.figures import Figure, draw_scene, moment, panels
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

R = 0.03
RHO = 0.012
AXLE = np.array([0.055, 0.0, 0.0525])
H, TIME = 0.02, 3.0
"""Time step and length of the run [s]."""
MIDDLE = ("palm", "_4.0", "_5.0", "_6.0", "_7.0", "drum")
"""Parts of the names of what belongs to the middle finger, its palm and the drum."""


def scene_and_run(h: float = H, mu_v: float = 1.5) -> tuple[Scenario, Trajectory]:
    """The scene and its run, at a time step h [s] and mu_v of the fingertips [-]."""
    settings = f"h={h}", f"steps={round(TIME / h)}", f"contacts.tips.mu_v={mu_v}"
    return scenario_run("allegro_turn", *settings)


def angles(scenario: Scenario, run: Trajectory) -> tuple[Array, Array]:
    """Of the drum, and of a drum on which the tip rolls, shapes (N,), since they touched [rad]."""
    system = scenario.system
    tip = system.link("hand/link_7.0_tip")
    axle = system.joint("roller/axle")
    poses = [system.kinematics(q) for q in run["q"]]
    x, _, z = np.transpose([pose.t[tip] - AXLE for pose in poses])
    R_tip = np.array([pose.R[tip] for pose in poses])
    gamma = np.arctan2(x, z)
    psi = np.arctan2(R_tip[:, 0, 2], R_tip[:, 2, 2])
    theta = np.append(0.0, np.cumsum(run["delta_q"][:, axle.v]))
    touch = 1 + int(np.argmax(run["wrench"][:, 1, 2] > 0))
    rolled = ((R + RHO) * gamma - RHO * psi) / R
    return (theta - theta[touch])[touch:], (rolled - rolled[touch])[touch:]


def main() -> Numbers:
    """Angles at the end, with friction and without."""
    theta, rolled = angles(*scene_and_run())
    smooth, _ = angles(*scene_and_run(mu_v=0))
    return {
        "turn of the drum [rad]": theta[-1],
        "worst difference from rolling [rad]": np.abs(theta - rolled).max(),
        "turn of the drum without friction [rad]": np.abs(smooth).max(),
    }


def figure(ax: Any = None, *, h: float = H, mu_v: float = 1.5) -> Figure:
    """The middle of the three fingers from the side, and the drum's angle.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    h, mu_v : float
        [s]; of the fingertips [-].
    """
    page, (left, right) = panels(6.3, 3.2, columns=2, within=ax)
    scenario, run = scene_and_run(h, mu_v)
    shown = only(moment(scenario, run, round(1.8 / h)), MIDDLE, [1])
    draw_scene(left, shown, view="xz", parts=("contacts", "cones", "forces"))
    theta, rolled = angles(scenario, run)
    times = run["t"][-len(theta) :]
    right.plot(times, theta, label="drum")
    right.plot(times, rolled, color="black", linestyle=":", label="pure rolling")
    label_axes(right, "time t [s]", "angle since they touched [rad]", caption(h))
    return page
