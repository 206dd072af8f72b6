"""Two bodies that move: J is that of beta's body less that of alpha's.

A ball on springs next to a free box. What a contact feels is how its point beta moves relative to
its point alpha, Eq. (2), so the columns of alpha's body bear a minus. A motion of both as one body
changes neither their distance nor their spin; along the surface alpha and beta then move apart by
phi w x n, because they are two points.
"""

from typing import Any

import numpy as np
import pinocchio as pin

from docs.drawings.labels import label_axes
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.lab.made_steps.free_pair import geometry
from quasistatic_ref.lab.made_steps.systems import body_text, on_link, system_of
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled
from quasistatic_ref.shapes.placed_shape import Box, Sphere
from quasistatic_ref.step.data import Contacts

RADIUS, HALF = 0.02, (0.04, 0.03, 0.03)
"""Of the ball, and half the sides of the box [m]."""
PHI, TURN = 0.015, 20.0
"""Between them [m]; of the box about y [deg]."""
DELTA_Q = np.array([0.02, 0, -0.006, 0, 0.3, 0, -0.004, 0, 0.02, 0, -0.3, 0])
"""What is drawn: of the ball, then of the box [m, rad]."""


def pair_at(phi: float = PHI, turn: float = TURN) -> tuple[Kinematics, ClosestPoints, Contacts]:
    """The bodies, their closest points, and the contact with the package's J.

    Parameters
    ----------
    phi : float
        [m].
    turn : float
        Of the box about y [deg].
    """
    text = body_text(1.0, (1e-3, 1e-3, 1e-3))
    system = system_of({"ball": text, "box": text}, ball={"actuated": ["base"]})
    ball = on_link(system, "ball", Sphere(RADIUS))
    box = on_link(system, "box", Box(np.array(HALF)))
    angle = np.radians(turn)
    n = np.array([np.cos(angle), 0, -np.sin(angle)])  # the box's own x: its face looks back along n
    place = np.concatenate([-(RADIUS + phi + HALF[0]) * n, np.zeros(7), [0, angle, 0]])
    place = np.delete(place, 9)  # ball along its axes, about them; then the box
    q = system.integrate(system.q_start, place)
    points, found = geometry(system, ContactPair("push", ball, box, 0.5, 0.01, 6, 1), q)
    return system.kinematics(q), points, found


def point_jacobian(R: Array, r: Array, n: Array) -> Array:
    """How a body moves one of its points, and turns about n, by its twist: shape (4, 6).

    Parameters
    ----------
    R : ndarray, shape (3, 3)
    r : ndarray, shape (3,)
        The point, in the body's frame [m].
    n : ndarray, shape (3,)
    """
    return np.block([[R, -R @ pin.skew(r)], [np.zeros((1, 3)), n[None] @ R]])


def by_hand(at: Kinematics, points: ClosestPoints) -> tuple[Array, Array]:
    """J of alpha's body and of beta's, each shape (4, 6); that of the contact is [-J, J]."""
    ends = (points.alpha[0], points.beta[0])
    of_alpha, of_beta = (
        point_jacobian(at.R[k], at.R[k].T @ (end - at.t[k]), points.n[0])
        for k, end in zip((1, 2), ends, strict=True)
    )
    return of_alpha, of_beta


def figure(*, phi: float = PHI, turn: float = TURN) -> Figure:
    """The motions of alpha and beta and their difference; which columns of J a contact has.

    Parameters
    ----------
    phi : float
        [m].
    turn : float
        Of the box about y [deg].
    """
    page, (left, right) = panels(6.3, 3.2, columns=2)
    at, points, _ = pair_at(phi, turn)
    angle = np.linspace(0, 2 * np.pi, 100)
    ball = at.t[1] + RADIUS * np.column_stack([np.cos(angle), 0 * angle, np.sin(angle)])
    corners = np.array(HALF) * [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]
    box = at.t[2] + corners @ at.R[2].T
    for outline, shade in ((ball, "0.85"), (box, "0.93")):
        left.fill(*1e3 * outline[:, [0, 2]].T, facecolor=shade, edgecolor="0.3", linestyle="-")
    alpha = 1e3 * points.alpha[0, [0, 2]]
    beta = 1e3 * points.beta[0, [0, 2]]
    J_alpha, J_beta = by_hand(at, points)
    of_alpha = 1e3 * J_alpha @ DELTA_Q[:6]
    of_beta = 1e3 * J_beta @ DELTA_Q[6:]
    for start, motion, name, colour, pattern in (
        (alpha, of_alpha, "motion of alpha", "#0072B2", "--"),
        (beta, of_beta, "motion of beta", "black", "-"),
        (beta, of_beta - of_alpha, r"difference, J $\delta q$", "#D55E00", "-."),
    ):
        end = start + motion[[0, 2]]
        head = {
            "arrowstyle": "-|>",
            "color": colour,
            "linestyle": "none",
            "shrinkB": 0,
            "mutation_scale": scaled(14),
        }
        left.plot(*np.transpose([start, end]), pattern, color=colour, label=name)
        left.annotate("", end, (start + 9 * end) / 10, arrowprops=head, annotation_clip=False)
    left.plot(*np.transpose([alpha, beta]), "ko", markersize=scaled(3), label="alpha and beta")
    x, z, reach = *(alpha + beta) / 2, 1e3 * RADIUS
    left.set(aspect="equal", xlim=(x - reach, x + reach), ylim=(z - reach, z + reach))
    label_axes(left, "x [mm]", "z [mm]")
    _columns(right)
    return page


def _columns(axes: Any) -> None:
    """Which entries of J are not zero for two contacts of the grasp: whose columns they are."""
    run = load_scenario("bunny_grasp", ["steps=1"], fast=True).run(progress=False)
    found = run.step_data(0).contacts
    finger, floor = (
        next(J for J, name in zip(found.J, found.name, strict=True) if word in name)
        for word in ("left_finger", "floor")
    )
    both = np.vstack([finger, floor])
    row, column = np.nonzero(both)
    palm = column < finger.shape[1] - 6
    style: dict[str, Any] = {"linestyle": "", "markersize": scaled(5)}
    axes.plot(column[palm], row[palm], "s", color="black", markerfacecolor="white",
              label="columns of alpha's body", **style)  # fmt: skip
    axes.plot(
        column[~palm], row[~palm], "D", color="#0072B2", label="columns of beta's body", **style
    )
    axes.axhline(3.5, color="0.3", linestyle="-")
    for edge in (5.5, 6.5):
        axes.axvline(edge, color="0.7", linestyle="-")
    axes.set(xlim=(-0.6, 12.6), ylim=(7.6, -0.6))
    axes.set_yticks(range(8), ["finger: x", "y", "z", "about n", "floor: x", "y", "z", "about n"])
    axes.set_xticks([2.5, 6, 9.5], ["palm", "width", "bunny"])
    axes.grid(visible=False)
    label_axes(axes, title="entries of J that are not zero")
