"""The paper's Figure 1 in closed form: two fingertips hold a bar off its centre of mass."""

from __future__ import annotations

import numpy as np

from quasistatic_ref.lab.validate.bodies import (
    GRAVITY,
    X,
    Y,
    contacts_of,
    exact,
    grid,
    threshold,
    twist_jacobian,
)
from quasistatic_ref.lab.validate.claim import Claim, Evidence, comparison
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M, HALF_WIDTH, STIFFNESS, H = 0.2, 0.03, 1000.0, 0.01
PRECISION = 1e-13
"""Where the bisection of a threshold ends, relative; below CLOSED_FORM."""


def pinched(grip: float, offset: float, mu_v: float, mu_omega: float) -> StepData:
    """A bar between fingertips on the axis x, which is `offset` [m] along y from its centre."""
    frames, J = [], np.zeros((2, 4, 8))
    for j, side in enumerate((1.0, -1.0)):
        n = side * X
        frames.append([Y, np.cross(n, Y), n])
        J[j, :3, j] = -n  # finger j closes along n
        J[j, :, 2:] = twist_jacobian(np.array([-side * HALF_WIDTH, offset, 0.0]), n)
    return StepData(
        h=H,
        K_q=STIFFNESS * np.eye(2),
        M_u=np.diag([M, M, M, 1e-4, 1e-4, 1e-4]),
        tau_a=np.zeros(2),
        tau_u=np.array([0, 0, -M * GRAVITY, 0, 0, 0]),
        delta_q_bar_a=np.full(2, grip / STIFFNESS),
        contacts=contacts_of(0.0, frames, J, mu_v, mu_omega, rows=6),
    )


def evidence() -> Evidence:
    """The offset at which the bar begins to turn."""
    found, expected, loads, grips = [], [], [], []
    for grip, mu_v, mu_omega in grid([4.0, 10.0, 40.0], [0.4, 0.8], [0.005, 0.02]):
        limit = mu_omega * (2 * grip / (M * GRAVITY) - 1 / mu_v)

        def moves(offset: float, of: tuple[float, float, float] = (grip, mu_v, mu_omega)) -> bool:
            return bool(np.any(exact(pinched(of[0], offset, *of[1:])).delta_q))

        found.append(threshold(moves, 0.5 * limit, 2 * limit, PRECISION))
        expected.append(limit)
        loads.append(exact(pinched(grip, 0.9 * limit, mu_v, mu_omega)).wrench[:, 2])
        grips.append([grip, grip])
    return Evidence(
        (
            comparison("offset that turns the bar [m]", found, expected, CLOSED_FORM, expected),
            comparison("normal force of a finger [N]", loads, grips, CLOSED_FORM, grips),
        )
    )


CLAIM = Claim(
    name="pinch",
    sentence="Two fingers that press with N hold a bar without any motion while the offset of its "
    "centre of mass is at most mu_omega (2 N / (m g) - 1 / mu_v).",
    where="docs/derivations.md (R14); the paper, Fig. 1",
    sweep="three grips, two mu_v, two mu_omega; each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=evidence,
)
