"""Boxes on each other, and what their contacts bear: weights, and the force of a spring."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref import StepData
from tests.made import GRAVITY, contacts_of, point_jacobian

SIDE = 0.1
"""Of a box [m]."""


class Loaded(NamedTuple):
    """A step in which everything stands, and what contacts bear.

    Parameters
    ----------
    step : StepData
    borne : ndarray, shape (levels,)
        Sum of the normal forces of each level: of the floor, of the lowest box, ... [N]. A level
        has four contacts, at the corners.
    """

    step: StepData
    borne: np.ndarray


def loaded_pile(
    masses: Sequence[float],
    h: float,
    *,
    spring: float | None = None,
    press: float = 0.0,
    unit: float = 1.0,
) -> Loaded:
    """A pile of cubes, the first on the floor, the last under a plate on a spring.

    Parameters
    ----------
    masses : sequence of float
        [kg].
    h : float
        Time step [s].
    spring : float, optional
        Stiffness of the plate, which moves along z [N/m]; none by default.
    press : float
        Force of the spring [N].
    unit : float
        The unit of length in which the step is written [m].
    """
    n_a = 0 if spring is None else 1
    n_u = len(masses)
    levels = n_u + n_a
    side = SIDE / unit
    corners = side / 2 * np.array([[x, y, 0.0] for x in (-1, 1) for y in (-1, 1)])
    up = np.array([0.0, 0.0, side / 2])
    at_bottom, at_top = (point_jacobian(corners + z, up / up[2]) for z in (-up, up))
    J = np.zeros((levels, 4, 4, n_a + 6 * n_u))
    J[n_u:, :, 2, :n_a] = 1.0
    of_bodies = J[..., n_a:].reshape(levels, 4, 4, n_u, 6)
    each = np.arange(n_u)
    of_bodies[each, :, :, each] = at_bottom
    below = np.arange(levels - 1)
    of_bodies[below + 1, :, :, below] = -at_top
    J[..., n_a:] = of_bodies.reshape(levels, 4, 4, 6 * n_u)
    stiffness = spring or 0.0
    step = StepData(
        h=h,
        K_q=stiffness * np.eye(n_a),
        M_u=np.kron(np.diag(masses), np.diag([1.0] * 3 + [side * side / 6] * 3)),
        tau_a=np.zeros(n_a),
        tau_u=np.kron(masses, -GRAVITY / unit * np.eye(6)[2]),
        delta_q_bar_a=np.full(n_a, -press / unit / (stiffness or 1.0)),
        contacts=contacts_of(
            0.0, np.tile(np.eye(3), (4 * levels, 1, 1)), J.reshape(4 * levels, 4, -1), 0.5
        ),
    )
    weights = GRAVITY * np.cumsum([*masses][::-1])[::-1]
    return Loaded(step, (np.append(weights, np.zeros(n_a)) + press) / unit)
