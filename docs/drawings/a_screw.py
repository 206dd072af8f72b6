"""q (+) delta_q is a screw: a body that goes ahead and turns at once moves on an arc.

A free body's delta_q is a twist in the body's own frame: how far along its axes, how much about
them. Both are done together, q exp6(delta_q), so that "ahead" turns with the body. After a turn of
theta a step ahead of d has led to d sin(theta) / theta and d (1 - cos(theta)) / theta.
"""

import numpy as np

from quasistatic_ref.lab.figures.labels import label_axes
from quasistatic_ref.lab.scenes.systems import body_text, system_of
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.step.data import Array

AHEAD, TURN = 0.1, 120.0
"""The twist: along the body's x [m], about its z [deg]."""

CORNERS = np.array([[-1, -1, 0], [1, -1, 0], [1.6, 0, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0]])
"""Outline of the body, with a nose, over 10 mm."""


def poses(ahead: float = AHEAD, turn: float = TURN, count: int = 6) -> tuple[Array, Array]:
    """Orientations (count, 3, 3) and places (count, 3) [m] of a body after parts of one twist.

    Parameters
    ----------
    ahead, turn : float
        [m], [deg].
    count : int
        The first part is none of it, the last all of it.
    """
    system = system_of({"body": body_text(1.0, (1e-3, 1e-3, 1e-3))})
    twist = np.array([ahead, 0, 0, 0, 0, np.radians(turn)])
    link = system.link("body")
    reached = [
        system.kinematics(system.integrate(system.q_start, share * twist))
        for share in np.linspace(0, 1, count)
    ]
    return np.array([k.R[link] for k in reached]), np.array([k.t[link] for k in reached])


def main() -> dict[str, float]:
    """Where the twist leads, with the formulas, and where one after the other would."""
    _, t = poses()
    theta = np.radians(TURN)
    return {
        "x [mm]": 1e3 * t[-1, 0],
        "d sin(theta) / theta [mm]": 1e3 * AHEAD * float(np.sin(theta) / theta),
        "y [mm]": 1e3 * t[-1, 1],
        "d (1 - cos(theta)) / theta [mm]": 1e3 * AHEAD * float((1 - np.cos(theta)) / theta),
    }


def figure(*, ahead: float = AHEAD, turn: float = TURN, count: int = 6) -> Figure:
    """The body along its screw; dotted, straight on and then turned.

    Parameters
    ----------
    ahead, turn : float
        [m], [deg].
    count : int
        Poses that are drawn.
    """
    page, (axes,) = panels(4.6, 3.4)
    R, t = poses(ahead, turn, count)
    outline = 0.01 * CORNERS
    for k, (R_k, t_k) in enumerate(zip(R, t, strict=True)):
        x, y, _ = 1e3 * (outline @ R_k.T + t_k).T
        axes.fill(x, y, facecolor="0.85", edgecolor="black", linewidth=scaled(0.8),
                  linestyle="-", label="fractions of one twist" if k == 0 else None)  # fmt: skip
    x, y, _ = 1e3 * (outline @ R[-1].T + [ahead, 0, 0]).T
    axes.fill(x, y, facecolor="none", edgecolor="black", linestyle=":", linewidth=scaled(1.2),
              label="straight first, then turned")  # fmt: skip
    path = poses(ahead, turn, 60)[1]
    axes.plot(1e3 * path[:, 0], 1e3 * path[:, 1], label="path of the origin")
    axes.set_aspect("equal")
    label_axes(axes, "x [mm]", "y [mm]", f"twist: {1e3 * ahead:g} mm along x, {turn:g} deg about z")
    return page
