"""What a barrier in place of each row does to a step and to its gradient.

A ball near the floor: with a barrier of weight kappa it floats above the floor, the farther the
larger kappa is, and no touching begins or ends, so that its step has a derivative everywhere, also
at the kink, where it is between those of both sides. Away from kinks, step and derivative tend to
the exact ones with kappa.
"""

import numpy as np

from quasistatic_ref.lab.figures.labels import caption, label_axes, note_below
from quasistatic_ref.lab.scenes.nudge import RADIUS, H, body_at_rest
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.smoothed import smoothed
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.shapes.placed_shape import Sphere

G = 9.81
NONE = np.zeros(0)
UP = np.eye(6)[2]
LEAST, MOST = 1e-12, 1e-5
"""Weights of the barriers of the right panel [N m s]."""
DRAWN = (1e-6, 1e-7, 1e-8)
"""Those of the left one [N m s]."""


def heights(moves: Array, kappa: float) -> Array:
    """Height of the centre after a smoothed step, (N,) [m].

    Parameters
    ----------
    moves : ndarray, shape (N,)
        How far above the height from which the ball just reaches the floor it starts [m].
    kappa : float
        [N m s]; 0 for the exact step.
    """
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS + H**2 * G)
    starts = [simulator.system.integrate(q, move * UP) for move in moves]
    if kappa == 0:
        return np.array([simulator.step(start, NONE).q[2] for start in starts])
    return np.array([smoothed(simulator, start, NONE, kappa).result.q[2] for start in starts])


def biases(kappas: Array) -> tuple[Array, Array]:
    """Errors of the step [m] and of its derivative by the height [-], each (N,), of a pressed ball.

    Parameters
    ----------
    kappas : ndarray, shape (N,)
        [N m s].
    """
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS + H**2 * G / 2)
    exact = derivatives(simulator, q, NONE)
    found = [smoothed(simulator, q, NONE, kappa) for kappa in kappas]
    places = [each.result.q[2] - exact.result.q[2] for each in found]
    slopes = [each.dq_dq[2, 2] - exact.dq_dq[2, 2] for each in found]
    return np.abs(places), np.abs(slopes)


def figure(*, drawn: tuple[float, ...] = DRAWN) -> Figure:
    """The step about the kink for some weights, and the bias against the weight.

    Parameters
    ----------
    drawn : tuple of float
        Weights of the left panel [N m s].
    """
    page, (left, right) = panels(6.3, 2.8, columns=2)
    moves = np.linspace(-5e-4, 5e-4, 41)
    ends = heights(moves, 0.0) - RADIUS
    left.plot(1e3 * moves, 1e3 * ends, "-", color="black", label="exact")
    for kappa, style in zip(drawn, ("--", "-.", ":"), strict=False):
        name = rf"$\kappa$ = {kappa:g} N m s"
        ends = heights(moves, kappa) - RADIUS
        left.plot(1e3 * moves, 1e3 * ends, style, color="C0", label=name)
    label_axes(left, "start above the kink [mm]", "height after [mm]")
    kappas = np.geomspace(LEAST, MOST, 22)
    places, slopes = biases(kappas)
    right.loglog(kappas, 1e3 * places, "o", color="C0", markersize=scaled(3), label="step [mm]")
    right.loglog(kappas, slopes, "s", color="C1", markersize=scaled(3), label="derivative [-]")
    label_axes(right, r"$\kappa$ [N m s]", "off by, for a pressed ball [mm, -]")
    note_below([left, right], caption(H))
    return page
