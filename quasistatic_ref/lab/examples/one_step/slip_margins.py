"""How much friction each corner of a block has left, as it is pushed to its limit.

A block on four corners is pushed above the table, so that the front corners bear more than the rear
ones. Rigid contacts leave open how they share the friction: the multipliers of a proof do so in one
of many ways, and in another one at the next push. With a small compliance at each contact the
shares are unique, and what a corner uses of mu_v f_n rises continuously to 1, (R42) to (R44).
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Z
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

M, MU_V, H, HALF = 0.5, 0.4, 0.01, 0.05
"""Mass [kg], friction [-], time step [s], half of the block's side [m]."""
HEIGHT = 0.04
"""Of the push above the table [m]."""
PUSHES = np.linspace(0.0, 0.99, 100)
"""Over mu_v m g [-]."""
CORNERS = HALF * np.array([[x, y, -1.0] for x in (1, -1) for y in (1, -1)])


def used_share(wrench: Array, mu_v: float) -> Array:
    """(|f_1| + |f_2|) / (mu_v f_n), shape (n_c,) [-]; 0 where nothing is borne.

    Parameters
    ----------
    wrench : ndarray, shape (n_c, 4)
        [N, N m].
    mu_v : float
        [-].
    """
    f_1, f_2, f_n, _ = wrench.T
    spent = (np.abs(f_1) + np.abs(f_2)) / mu_v
    return np.asarray(np.divide(spent, f_n, out=np.zeros_like(spent), where=f_n > 0))


def shares(mu_v: float = MU_V, h: float = H) -> tuple[Array, Array]:
    """What each corner uses of its friction in each push: by `forces`, and by `wrench`.

    Returns
    -------
    ndarray, shape (pushes, 4), twice
        [-].
    """
    inertia = M * (2 * HALF) ** 2 / 6
    frames = np.tile([[1.0, 0, 0], [0, 1.0, 0], Z], (4, 1, 1))
    found = []
    for push in PUSHES * mu_v * M * GRAVITY:
        wrench = (push, 0, -M * GRAVITY, 0, (HEIGHT - HALF) * push, 0)
        step = rigid_step(M, inertia, wrench, CORNERS, frames, mu_v=mu_v, h=h)
        solution = solve_step(step, fast=True)
        found.append((used_share(solution.forces, mu_v), used_share(solution.wrench, mu_v)))
    forces, wrenches = np.array(found).swapaxes(0, 1)
    return forces, wrenches


def main() -> Numbers:
    """Largest rise from one push to the next, over that of the push, and the shares at the last."""
    forces, wrenches = shares()
    step = PUSHES[1] - PUSHES[0]
    return {
        "largest change of a share over that of the push, forces [-]": np.abs(
            np.diff(forces, axis=0)
        ).max()
        / step,
        "the same of the proof's multipliers [-]": np.abs(np.diff(wrenches, axis=0)).max() / step,
        "share of a front corner at the last push [-]": forces[-1, 0],
        "share of a rear corner at the last push [-]": forces[-1, 2],
    }


def figure(ax: Any = None, *, mu_v: float = MU_V, h: float = H) -> Figure:
    """What the corners use of their friction, against the push.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    mu_v, h : float
        [-], [s].
    """
    page, (left, right) = panels(6.3, 3.0, columns=2, within=ax)
    forces, wrenches = shares(mu_v, h)
    names = ("front left", "front right", "rear left", "rear right")
    for drawn, found in ((left, forces), (right, wrenches)):
        for j, name in enumerate(names):
            drawn.plot(
                PUSHES, found[:, j], ("-", "--", "-.", ":")[j],
                label=name, linewidth=scaled(1.2),
            )  # fmt: skip
    label_axes(left, "push / (mu_v m g) [-]", "friction used: forces [-]", caption(h))
    label_axes(right, "push / (mu_v m g) [-]", "friction used: multipliers [-]", caption(h))
    return page
