"""A compliant peg finds a hole that it misses by 3 mm and 2 mm, and slides in along two walls.

The gantry's springs give way until the peg is in. Inside, they press it on the walls with
K (e - c + b), b being the boundary layer, and friction on both walls holds it back.
"""

import numpy as np

from quasistatic_ref.figures import Figure, draw_scene, moment, panels, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.runs import ran

K = np.array([500.0, 500.0, 2000.0])
MISS, CLEARANCE, MU_V, V = np.array([0.003, 0.002]), 0.0005, 0.2, 0.01
SETTINGS = ("h=0.02", "steps=200")
WALLS = ("east", "west", "north", "south")


def main() -> Numbers:
    """Forces of the walls that the peg slides along, and its lag in depth, with their formulas."""
    scenario, run = ran("peg_in_hole", *SETTINGS)
    layer = MU_V * scenario.h * V
    east, _, north, _ = run["wrench"][-1, :, 2]
    N_x, N_y = K[:2] * (MISS - CLEARANCE + layer)
    return {
        "force of the east wall [N]": east,
        "K_x (e_x - c + b) [N]": N_x,
        "force of the north wall [N]": north,
        "K_y (e_y - c + b) [N]": N_y,
        "lag in depth [mm]": 1e3 * (run["q"][-1, 2] - run["q_bar_a"][-1, 2]),
        "mu_v (N_x + N_y) / K_z [mm]": 1e3 * MU_V * (N_x + N_y) / K[2],
    }


@styled
def figure() -> Figure:
    """The peg on its way in, and the forces of the walls."""
    page, (left, right) = panels(6.3, 3.0, columns=2)
    scenario, run = ran("peg_in_hole", *SETTINGS)
    tip = np.array([0.0, 0.0, -0.005])
    draw_scene(left, moment(scenario, run, 120), view="xz", around=(tip, 0.03))
    for wall, force in zip(WALLS, run["wrench"][:, :, 2].T, strict=True):
        right.plot(run["t"], force, label=wall)
    right.set(xlabel="time t [s]", ylabel="normal force of a wall [N]")
    right.set_title(f"h = {1e3 * scenario.h:g} ms, friction {scenario.cone}", loc="right")
    right.legend(loc="center right")
    return page


if __name__ == "__main__":
    script(main, figure)
