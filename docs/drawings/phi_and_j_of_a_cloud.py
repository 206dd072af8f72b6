"""phi and J of a cloud: how far each point is from the floor, and how that changes.

Each point of a body's cloud may touch. Of a floor phi is the point's height, n is up, and J says
how the point moves when the body does: along its axes by the axes, about them by omega x r. The k
points with the least phi become the contacts of a step. Row n'J predicts phi after a motion to
first order: the error of a turn grows with its square.
"""

from typing import Any

import numpy as np

from docs.drawings.labels import label_axes
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.made_steps.free_pair import geometry
from quasistatic_ref.lab.made_steps.systems import body_text, cloud_on, system_of
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape

HALF_AXES, POINTS, K, HEIGHT, TILT = (0.05, 0.03), 40, 5, 0.032, 25.0
"""Of an ellipse [m]; points on it; points that become contacts; of its centre [m]; tilt [deg]."""

FLOOR = PlacedShape.in_world("floor", HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0))
TURNS = np.geomspace(1e-3, 0.3, 12)
"""About y [rad]."""


def cloud() -> Array:
    """An ellipse of points in the plane y = 0 of its body, shape (POINTS, 3) [m]."""
    angle = 2 * np.pi * np.arange(POINTS) / POINTS
    return np.column_stack([HALF_AXES[0] * np.cos(angle), 0 * angle, HALF_AXES[1] * np.sin(angle)])


def points_at(system: System, q: Array) -> Array:
    """The points of the cloud in the world at q, shape (POINTS, 3) [m]."""
    at = system.kinematics(q)
    link = system.link("body")
    return np.asarray(cloud() @ at.R[link].T + at.t[link])


def tilted_scene(tilt: float = TILT, k: int = K) -> tuple[System, ContactPair, Array]:
    """The body with its cloud, its pair with the floor, and q when it is tilted.

    Parameters
    ----------
    tilt : float
        About y [deg].
    k : int

    Returns
    -------
    tuple of System, ContactPair and ndarray, shape (n_q,)
    """
    system = system_of({"body": body_text(1.0, (1e-3, 1e-3, 1e-3))})
    points = cloud_on(system, "body", cloud())
    pair = ContactPair("floor", FLOOR, points, 0.5, 0.0, 4, k)
    above = np.array([0, 0, HEIGHT + 0.01, 0, 0, 0])
    q = system.integrate(system.integrate(system.q_start, above), np.radians(tilt) * np.eye(6)[4])
    return system, pair, q


def errors(turns: Array = TURNS, tilt: float = TILT) -> Array:
    """Largest difference of phi after turns about the body's y from phi + n'J delta_q, (N,) [m].

    Parameters
    ----------
    turns : ndarray, shape (N,)
        [rad].
    tilt : float
        [deg].
    """
    system, pair, q = tilted_scene(tilt, POINTS)  # every point, always in the same order
    _, found = geometry(system, pair, q)
    order = [int(name.rsplit("/", 1)[1]) for name in found.name]
    worst = []
    for turn in turns:
        delta_q = turn * np.eye(6)[4]
        height = points_at(system, system.integrate(q, delta_q))[order, 2]
        predicted = found.phi + np.einsum("ci,civ,v->c", found.n, found.J[:, :3], delta_q)
        worst.append(np.abs(height - predicted).max())
    return np.array(worst)


def figure(*, tilt: float = TILT, k: int = K) -> Figure:
    """The cloud, phi of all and the k contacts with the motion of a turn; the prediction's error.

    Parameters
    ----------
    tilt : float
        [deg].
    k : int
        Points that become contacts.
    """
    page, (left, right) = panels(6.3, 3.2, columns=2)
    system, pair, q = tilted_scene(tilt, k)
    points, found = geometry(system, pair, q)
    x, _, z = 1e3 * points_at(system, q).T
    left.vlines(x, 0, z, color="0.8", linewidth=scaled(0.6), linestyle="-", label=r"$\phi$")
    marks: dict[str, Any] = {"linestyle": "", "markersize": scaled(3)}
    left.plot(x, z, "o", color="#0072B2", label="points", **marks)
    beta = 1e3 * points.beta
    left.plot(beta[:, 0], beta[:, 2], "s", color="#D55E00", label=f"k = {k} contacts", **marks)
    motion = 300 * found.J[:, :3, 4]  # for a turn of 0.3 rad about y, in mm
    for start, along in zip(beta[:, [0, 2]], motion[:, [0, 2]], strict=True):
        left.annotate("", start + along, start, annotation_clip=False,
                      arrowprops={"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0,
                                  "color": "black", "linewidth": scaled(0.8)})  # fmt: skip
    left.axhline(0, color="0.3", linestyle="-")
    left.set_aspect("equal")
    label_axes(left, "x [mm]", "z [mm]", "arrows: J for 0.3 rad")
    right.loglog(TURNS, 1e3 * errors(TURNS, tilt), marker="o", markersize=scaled(3), label="error")
    second = 0.5 * HALF_AXES[0] * TURNS**2
    right.loglog(TURNS, 1e3 * second, "k:", label=r"$r\,\theta^2 / 2$, r = 50 mm")
    label_axes(right, r"turn $\theta$ [rad]", r"error of $\phi + J_n\,\delta q$ [mm]")
    return page
