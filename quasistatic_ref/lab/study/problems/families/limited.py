"""Joints with limits: a box around the displacement of a gripper."""

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.study.problems.families.shaped import FLOOR, GRIP, base
from quasistatic_ref.lab.study.problems.families.short import OF_J, framed, shortened
from quasistatic_ref.step.data import Extra, StepData

FREE = 1e-4
"""Largest gap to the floor of a body whose gripper is at its limits [m]."""
HELD = 2.0**-4
"""Travel of a gripper at its limits, over how far it reaches into the body [-]."""


def within_limits(rng: Rng, travel: float) -> StepData:
    """A grasp in which each joint can move by about `travel` either way [m, rad]."""
    step = base(rng)
    c = step.contacts
    # Gaps that are not negative: to stand still is then allowed, whatever the limits.
    return _limited(
        rng, step.replace(contacts=framed(c.J, np.abs(c.phi), c.mu_v, c.mu_omega, c.rows)), travel
    )


def at_its_limits(rng: Rng, clearance: float) -> StepData:
    """A gripper that can hardly move, whose fingers are at the distance `clearance` of the body.

    Parameters
    ----------
    rng : Generator
    clearance : float
        Negative where both fingers reach into the body [m].
    """
    step = base(rng)
    c = step.contacts
    floor = shortened(rng.uniform(0, FREE, FLOOR), OF_J)
    phi = np.concatenate([np.full(GRIP, clearance), floor])
    held = step.replace(contacts=framed(c.J, phi, c.mu_v, c.mu_omega, c.rows))
    return _limited(rng, held, HELD * abs(clearance))


def _limited(rng: Rng, step: StepData, travel: float) -> StepData:
    """The step with a lower and an upper limit of each joint."""
    n_a = step.n_a
    one = np.eye(n_a, step.n_v)
    names = [f"{side} limit of joint {i}" for side in ("lower", "upper") for i in range(n_a)]
    travels = shortened(travel * rng.uniform(0.5, 1.5, 2 * n_a), OF_J)
    return step.replace(extra=Extra(tuple(names), np.concatenate([one, -one]), -travels))
