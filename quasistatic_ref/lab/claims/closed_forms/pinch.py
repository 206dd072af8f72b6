"""The paper's Figure 1 in closed form: two fingertips hold a bar off its centre of mass."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.2
"""Mass of the bar [kg]."""


def held_bar(offset: float, grip: float, mu_v: float, mu_omega: float) -> StepData:
    """A bar that is held at an offset [m]."""
    return pinch_step(grip, offset, mu_v, mu_omega, m=M)


def evidence() -> Evidence:
    """The offset at which the bar begins to turn."""
    sweep = grid([4.0, 10.0, 40.0], [0.4, 0.8], [0.005, 0.02])
    grip, mu_v, mu_omega = sweep.T
    expected = mu_omega * (2 * grip / (M * GRAVITY) - 1 / mu_v)
    measured = thresholds(held_bar, sweep, expected)
    steps = (held_bar(0.9 * limit, *of) for limit, of in zip(expected, sweep, strict=True))
    loads = [exact(step).wrench[:, 2] for step in steps]
    grips = np.stack([grip, grip], axis=1)
    return Evidence.of(
        comparison("offset that turns the bar [m]", measured, expected, CLOSED_FORM, expected),
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
