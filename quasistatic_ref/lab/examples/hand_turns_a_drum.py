"""A hand turns an object: three fingers of an Allegro hand roll on a drum and turn it.

The drum's axle is not driven. The middle fingertip, a sphere, rolls without slipping; then the
drum's angle theta obeys R theta = (R + rho) gamma - rho psi, gamma being the angle of the tip about
the axle and psi the turn of its link. The hand comes with the extra `robots`.
"""

import numpy as np

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran
from quasistatic_ref.step.data import Array

R, RHO, AXLE = 0.03, 0.012, np.array([0.055, 0.0, 0.0525])
SETTINGS = ("h=0.02", "steps=150")


def angles(*settings: str) -> tuple[Array, Array]:
    """Of the drum, and of a drum on which the tip rolls, shapes (N,), since they touched [rad]."""
    scenario, run = ran("allegro_turn", *SETTINGS, *settings)
    system = scenario.system
    tip, axle = system.link("hand/link_7.0_tip"), system.joint("roller/axle")
    poses = [system.kinematics(q) for q in run["q"]]
    x, _, z = np.transpose([pose.t[tip] - AXLE for pose in poses])
    turned = np.array([pose.R[tip] for pose in poses])
    gamma = np.arctan2(x, z)
    psi = np.arctan2(turned[:, 0, 2], turned[:, 2, 2])
    theta = np.append(0.0, np.cumsum(run["delta_q"][:, axle.v]))
    touch = 1 + int(np.argmax(run["wrench"][:, 1, 2] > 0))
    rolled = ((R + RHO) * gamma - RHO * psi) / R
    return (theta - theta[touch])[touch:], (rolled - rolled[touch])[touch:]


def main() -> Numbers:
    """Angles at the end, with friction and without."""
    theta, rolled = angles()
    smooth, _ = angles("contacts.tips.mu_v=0")
    return {
        "turn of the drum [rad]": theta[-1],
        "worst difference from rolling [rad]": np.abs(theta - rolled).max(),
        "turn of the drum without friction [rad]": np.abs(smooth).max(),
    }


@styled
def figure() -> Figure:
    """The hand from the side, and the drum's angle."""
    page, (left, right) = panels(6.3, 3.2, columns=2)
    scenario, run = ran("allegro_turn", *SETTINGS)
    draw_scene(left, moment(scenario, run, 90), view="xz", parts=("contacts", "cones", "forces"))
    theta, rolled = angles()
    times = run["t"][-len(theta) :]
    right.plot(times, theta, label="drum")
    right.plot(times, rolled, color="black", linestyle=":", label="rolling without slipping")
    right.set(xlabel="time t [s]", ylabel="angle since the first touch [rad]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    right.legend()
    return page


if __name__ == "__main__":
    script(main, figure)
