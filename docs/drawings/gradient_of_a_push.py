"""What a gradient through contact is: how the end of a step turns with the place of the finger.

A finger pushes a ball. Where it stands a little farther to the side, it pushes in another
direction: the normal turns, by both curvatures. A flat finger that touches the same point with the
same normal makes the same step, and has another gradient, since its normal stays.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.figures.labels import caption, label_axes, note_below
from quasistatic_ref.lab.scenes.nudge import RADIUS, H, nudged_ball
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.shapes.placed_shape import HalfSpace, Sphere
from quasistatic_ref.step.data import Array

FINGER, AHEAD, GAP = 0.02, 0.006, 1e-4
"""Radius of the finger, how far its target is ahead, and how far it is from the ball [m]."""

X = -(RADIUS + FINGER + GAP)
"""Where the finger stands along x [m]."""

SIDES = np.array([-0.012, -0.004, 0.004, 0.012])
"""Where it stands to the side, at the tangents that are drawn [m]."""


def after(side: float, ahead: float = AHEAD) -> tuple[float, float, float]:
    """Place y of the ball after a step [m], its derivative by the finger's y [-], a flat finger's.

    Parameters
    ----------
    side : float
        y of the finger [m].
    ahead : float
        How far the finger's target is ahead of it [m].
    """
    n = np.array([-X, -side, 0.0]) / np.hypot(X, side)
    found = []
    for finger in (Sphere(FINGER), HalfSpace(n, FINGER)):
        simulator, q = nudged_ball(finger, (X, side))
        step = derivatives(simulator, q, q[:7] + ahead * np.eye(7)[0])
        R = simulator.system.kinematics(step.result.q).R[simulator.system.link("ball")]
        # The finger's start and its target go to the side together.
        column = step.dq_dq[6:9, 1] + step.dq_dq_bar_a[6:9, 1]
        found.append((float(step.result.q[8]), float((R @ column)[1])))
    return *found[0], found[1][1]


def curve(sides: Array, ahead: float = AHEAD) -> Array:
    """Place y of the ball after a step by that of the finger, (N,) [m].

    Parameters
    ----------
    sides : ndarray, shape (N,)
        [m].
    ahead : float
        [m].
    """
    ends = []
    for side in sides:
        simulator, q = nudged_ball(Sphere(FINGER), (X, side))
        ends.append(simulator.step(q, q[:7] + ahead * np.eye(7)[0]).q[8])
    return np.array(ends)


def figure(*, ahead: float = AHEAD) -> Figure:
    """Where the ball goes against where the finger stands, with tangents.

    Parameters
    ----------
    ahead : float
        How far the finger's target is ahead of it [m].
    """
    page, (left, right) = panels(6.3, 2.8, columns=2)
    for side, style in ((SIDES[0], "-"), (SIDES[-1], "--")):
        at = np.array([X, side])
        end = -0.6 * RADIUS * at / np.hypot(*at)
        _circle(left, at, FINGER, style, f"finger at y = {1e3 * side:g} mm")
        left.annotate("", tuple(1e3 * end), (0, 0), arrowprops={"arrowstyle": "->"})
    _circle(left, np.zeros(2), RADIUS, "-.", "ball, and where it is pushed")
    left.set_aspect("equal")
    label_axes(left, "x [mm]", "y [mm]")
    sides = np.linspace(-0.016, 0.016, 33)
    reach = np.array([-0.003, 0.003])
    ends = curve(sides, ahead)
    right.plot(1e3 * sides, 1e3 * ends, "o", color="C0", markersize=scaled(3), label="step")
    for k, side in enumerate(SIDES):
        y, slope, flat = after(float(side), ahead)
        labels = ("its derivative", "normal held fast") if not k else (None, None)
        x = 1e3 * (side + reach)
        right.plot(x, 1e3 * (y + slope * reach), "-", color="black", label=labels[0])
        right.plot(x, 1e3 * (y + flat * reach), "--", color="C1", label=labels[1])
    label_axes(right, "y of the finger [mm]", "y of the ball after [mm]")
    note_below([left, right], caption(H))
    return page


def _circle(axes: Any, middle: Array, radius: float, style: str, label: str) -> None:
    angle = np.linspace(0, 2 * np.pi, 97)
    around = middle[:, None] + radius * np.array([np.cos(angle), np.sin(angle)])
    axes.plot(*(1e3 * around), style, color="black", label=label)
