"""Where a step has no derivative: two kinks with their one-sided derivatives, and a jump.

A ball that just reaches the floor is stopped or falls on; one that is pushed as hard as friction
can bear stays or slides; and of a body of two points, of which the closest alone is kept, the step
jumps where they are equally near: no direction has a derivative.
"""

from typing import Any

import numpy as np

from docs.drawings.labels import label_axes, legend_below
from quasistatic_ref.lab.figures.labels import caption
from quasistatic_ref.lab.made_steps.nudge import MASS, MU_V, RADIUS, H, body_at_rest, points
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.shapes.placed_shape import Sphere

G = 9.81
NONE = np.zeros(0)
UP = np.eye(6)[2]
ACROSS = np.eye(6)[0]
TURN = np.eye(6)[4]
POINT = points((0.0, 0.0, 0.0))
TWO = points((-0.05, 0.0, 0.0), (0.05, 0.0, 0.0))
LIMIT = MU_V * MASS * G
"""What friction bears [N]."""


def fall_curve(moves: Array) -> tuple[Array, Array]:
    """Height of the centre after a step [m], (N,), and its derivatives [-] down and up, (2,).

    Parameters
    ----------
    moves : ndarray, shape (N,)
        How far above the height from which the ball just reaches the floor it starts [m].
    """
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS + H**2 * G)
    system = simulator.system
    ends = [simulator.step(system.integrate(q, move * UP), NONE).q[2] for move in moves]
    found = derivatives(simulator, q, NONE, by=())
    return np.array(ends), np.array([-found.along(q=-UP)[2], found.along(q=UP)[2]])


def push_curve(forces: Array) -> tuple[Array, Array]:
    """Place of a point after a step [m], (N,), and its derivatives [m/N] at the limit, (2,).

    Parameters
    ----------
    forces : ndarray, shape (N,)
        Push along x beyond what friction bears [N].
    """
    simulator, q = body_at_rest(POINT, 0.0)
    limit = LIMIT * ACROSS
    ends = [simulator.step(q, NONE, limit + force * ACROSS).q[0] for force in forces]
    found = derivatives(simulator, q, NONE, limit, by=())
    return np.array(ends), np.array([-found.along(tau=-ACROSS)[0], found.along(tau=ACROSS)[0]])


def tilt_curve(angles: Array) -> Array:
    """Tilt of a body of two points after a step, shape (N,) [rad].

    Parameters
    ----------
    angles : ndarray, shape (N,)
        Its tilt before [rad].
    """
    simulator, q = body_at_rest(TWO, 0.0)
    ends = []
    for angle in angles:
        end = simulator.step(simulator.system.integrate(q, angle * TURN), NONE).q
        ends.append(2 * np.arctan2(end[4], end[6]))
    return np.array(ends)


def figure(*, reach: float = 1.0) -> Figure:
    """The three steps against what they are functions of, with their one-sided derivatives.

    Parameters
    ----------
    reach : float
        How far to either side, relative to what the example shows [-].
    """
    page, grid = panels(6.3, 2.6, columns=3)
    moves = reach * np.linspace(-5e-4, 5e-4, 21)
    forces = reach * np.linspace(-0.2, 0.2, 21)
    ends, slopes = fall_curve(moves)
    _sides(grid[0], 1e3 * moves, 1e3 * (ends - RADIUS), slopes)
    label_axes(grid[0], "start above the kink [mm]", "height after [mm]", "just touches", key=False)
    ends, slopes = push_curve(forces)
    _sides(grid[1], forces, 1e3 * ends, 1e3 * slopes)
    label_axes(grid[1], "push beyond the limit [N]", "place after [mm]", "just holds", key=False)
    angles = reach * np.linspace(-0.01, 0.01, 21)
    ends = tilt_curve(angles)
    grid[2].plot(1e3 * angles, 1e3 * ends, "o", color="C0", markersize=scaled(3))
    label_axes(grid[2], "tilt before [mrad]", "tilt after [mrad]", "a tie of points")
    legend_below(list(grid), grid[0].get_legend_handles_labels()[0], caption(H))
    return page


def _sides(axes: Any, x: Array, y: Array, slopes: Array) -> None:
    axes.plot(x, y, "o", color="C0", markersize=scaled(3), label="step")
    middle = len(x) // 2
    for part, slope, style in ((x[: middle + 1], slopes[0], "-"), (x[middle:], slopes[1], "--")):
        label = "derivative from below" if style == "-" else "from above"
        axes.plot(part, y[middle] + slope * (part - x[middle]), style, color="black", label=label)
