"""Random instances of the closed forms of docs/derivations.md: sizes that span decades."""

import numpy as np

from quasistatic_ref import solve_step
from tests.closeness import assert_within
from tests.tolerances import CLOSED_FORM

INSTANCES = 40
INFEASIBLE = {11, 12}
"""Seeds of mixed steps, of those below INSTANCES."""


def exact(step):
    """The optimum, without a solver."""
    return solve_step(step, "none")


def log(rng, low, high):
    return 10 ** rng.uniform(np.log10(low), np.log10(high))


def near(found, expected, scale):
    """Equal up to rounding, relative to a length or force of the instance."""
    assert_within(found, expected, CLOSED_FORM * scale)


def instances(rng, count=INSTANCES):
    """Mass [kg], time step [s], mu_v and mu_omega [m]."""
    for _ in range(count):
        yield log(rng, 0.01, 100), log(rng, 1e-3, 0.1), rng.uniform(0.05, 1.5), log(rng, 1e-3, 0.1)
