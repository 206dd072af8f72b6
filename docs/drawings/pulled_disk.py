"""A disk that a string pulls beside its centre: which point rests, and which force moves it."""

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import solve_step
from quasistatic_ref.lab.made_steps.rigid import rigid_step
from quasistatic_ref.optional.show.figures import Figure, panels

M, GRAVITY, MU_V, CHI = 0.5, 9.81, 0.4, 0.02  # kg, m/s^2, -, m: CHI is mu_omega / mu_v
LEVERS = np.array([5, 10, 15, 20, 30, 40, 50]) * 1e-3  # m
STYLES = {"ellipsoid": ("#0072B2", "o"), "pyramid": ("#E69F00", "s")}


def least_force(lever, cone):
    """What moves the disk, over mu_v m g [-]."""
    return 1 / (np.hypot(1, lever / CHI) if cone == "ellipsoid" else 1 + lever / CHI)


def resting_point(lever, cone):
    """Its distance from the centre [m], opposite of the string."""
    return CHI**2 / lever if cone == "ellipsoid" else np.full_like(lever, CHI)


def motion(share, lever, cone):
    """Translation [m] and turn [rad] of a step under a force of `share` mu_v m g."""
    f = share * MU_V * M * GRAVITY
    wrench = (f, 0, -M * GRAVITY, 0, 0, lever * f)
    step = rigid_step(
        M, M * CHI**2, wrench, [[0, 0, 0]], [np.eye(3)],
        mu_v=MU_V, mu_omega=MU_V * CHI, rows=6,
    ).replace(cone=cone)  # fmt: skip
    return solve_step(step).delta_q[[0, 5]]


def figure() -> Figure:
    """Left the point that rests, right the force, both against the lever."""
    page, (place, force) = panels(6.3, 3.0, columns=2)
    levers = np.linspace(LEVERS[0], LEVERS[-1], 100)
    for cone, (colour, mark) in STYLES.items():
        place.plot(1e3 * levers, 1e3 * resting_point(levers, cone), "-", color=colour)
        force.plot(1e3 * levers, least_force(levers, cone), "-", color=colour, label=cone)
        for lever in LEVERS:
            least = least_force(lever, cone)
            assert not motion(0.999 * least, lever, cone).any()
            v, omega = motion(1.001 * least, lever, cone)
            place.plot(1e3 * lever, 1e3 * v / omega, mark, color=colour)
            force.plot(1e3 * lever, least, mark, color=colour)
    label_axes(place, "lever p of the string [mm]", "centre to resting point [mm]", key=False)
    label_axes(force, "lever p of the string [mm]", r"least force / ($\mu_v m g$) [-]", key=False)
    place.set_ylim(0, 85)
    force.set_ylim(0, 1)
    legend_below([place, force], force.get_legend_handles_labels()[0])
    return page
