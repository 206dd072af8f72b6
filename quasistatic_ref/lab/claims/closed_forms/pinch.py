"""The paper's Figure 1 in closed form: two fingertips hold a bar off its centre of mass."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.measures import exact, grid, threshold
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.2
"""Mass of the bar [kg]."""


def evidence() -> Evidence:
    """The offset at which the bar begins to turn."""
    found = []
    expected = []
    loads = []
    grips = []
    for grip, mu_v, mu_omega in grid([4.0, 10.0, 40.0], [0.4, 0.8], [0.005, 0.02]):
        limit = mu_omega * (2 * grip / (M * GRAVITY) - 1 / mu_v)

        def moves(offset: float, of: tuple[float, float, float] = (grip, mu_v, mu_omega)) -> bool:
            return bool(np.any(exact(pinch_step(of[0], offset, *of[1:], m=M)).delta_q))

        found.append(threshold(moves, 0.5 * limit, 2 * limit))
        expected.append(limit)
        loads.append(exact(pinch_step(grip, 0.9 * limit, mu_v, mu_omega, m=M)).wrench[:, 2])
        grips.append([grip, grip])
    return Evidence.of(
        comparison("offset that turns the bar [m]", found, expected, CLOSED_FORM, expected),
        comparison("normal force of a finger [N]", loads, grips, CLOSED_FORM, grips),
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
