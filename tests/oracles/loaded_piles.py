"""Boxes on each other, and what their contacts bear: weights, and the force of a spring."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref import StepData
from tests.made import GRAVITY, contacts_of, point_jacobian

SIDE = 0.1
"""Of a box [m]."""


@dataclass(frozen=True)
class Loaded:
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
    side = SIDE / unit
    corners = side / 2 * np.array([[x, y, 0.0] for x in (-1, 1) for y in (-1, 1)])
    up = np.array([0.0, 0.0, side / 2])
    at_bottom, at_top = (point_jacobian(corners + z, [0.0, 0.0, 1.0]) for z in (-up, up))
    levels = len(masses) + n_a
    J = np.zeros((levels, 4, 4, n_a + 6 * len(masses)))
    for i in range(levels):
        above, below = (slice(n_a + 6 * k, n_a + 6 * k + 6) for k in (i, i - 1))
        if i < len(masses):
            J[i, :, :, above] += at_bottom
        else:
            J[i, :, 2, 0] = 1.0
        if i:
            J[i, :, :, below] -= at_top
    M_u = np.zeros((6 * len(masses), 6 * len(masses)))
    tau_u = np.zeros(6 * len(masses))
    for i, m in enumerate(masses):
        block = np.arange(6 * i, 6 * i + 6)
        M_u[block, block] = m * np.array([1.0, 1.0, 1.0, *[side * side / 6] * 3])
        tau_u[block[2]] = -m * GRAVITY / unit
    stiffness = 0.0 if spring is None else spring
    step = StepData(
        h=h,
        K_q=stiffness * np.eye(n_a),
        M_u=M_u,
        tau_a=np.zeros(n_a),
        tau_u=tau_u,
        delta_q_bar_a=np.full(n_a, -press / unit / (stiffness or 1.0)),
        contacts=contacts_of(
            0.0, np.tile(np.eye(3), (4 * levels, 1, 1)), J.reshape(-1, 4, J.shape[-1]), 0.5
        ),
    )
    weights = GRAVITY * np.cumsum([*masses][::-1])[::-1]
    return Loaded(step, (np.append(weights, np.zeros(n_a)) + press) / unit)
