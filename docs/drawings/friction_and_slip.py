"""Friction and gap against the slip of one step, in the model and under Coulomb's law.

A block rests on a table and is pushed harder and harder, each time for one step. Under both laws
it sticks up to the same friction force. Beyond, the model's block has to rise, which raises the
normal force and with it the friction.
"""

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref import coulomb_step, solve_step
from quasistatic_ref.lab.made_steps.rigid import point_step
from quasistatic_ref.optional.show.figures import Figure, panels

M, GRAVITY, MU_V, H = 1.0, 9.81, 0.5, 0.01  # kg, m/s^2, -, s
PUSHES = np.linspace(0.0, 15.0, 31)  # N


def main() -> dict[str, np.ndarray]:
    """For each law the slip, the gap [m] and the friction [N] of each push, shape (pushes, 3)."""
    laws = {"convex": solve_step, "coulomb": coulomb_step}
    steps = [point_step(M, (push, 0.0, -M * GRAVITY), MU_V, 0.0, H) for push in PUSHES]
    table = {}
    for law, solved in laws.items():
        answers = [solved(step) for step in steps]
        table[law] = np.array([[a.delta_q[0], a.delta_q[2], -a.wrench[0, 0]] for a in answers])
    slip, gap, friction = table["convex"].T
    slides = slip > 1e-9
    assert np.allclose(gap, MU_V * slip)
    # (R8): the normal force of a first step, and friction at its limit.
    beyond = (PUSHES - MU_V * M * GRAVITY) / (1 + MU_V**2)
    assert np.allclose(friction[slides], MU_V * (M * GRAVITY + MU_V * beyond)[slides])
    return table


def figure() -> Figure:
    """Left the friction, right the gap, both over the slip."""
    page, (left, right) = panels(6.3, 3.0, columns=2)
    looks = {"convex": "o-", "coulomb": "^--"}
    names = {"convex": "the model", "coulomb": "Coulomb's law"}
    for law, rows in main().items():
        slip, gap, friction = rows.T
        pen = {"color": "black", "markerfacecolor": "none", "markersize": 4, "label": names[law]}
        left.plot(1e3 * slip, friction, looks[law], **pen)
        right.plot(1e3 * slip, 1e3 * gap, looks[law], **pen)
    left.set_ylim(0, 8)
    label_axes(left, "slip in one step [mm]", "friction force [N]", key=False)
    label_axes(right, "slip in one step [mm]", "gap after the step [mm]", key=False)
    legend_below([left, right], left.get_legend_handles_labels()[0])
    return page
