"""A step with sigma times the inertia is the step of h / sqrt(sigma) with the inertia as it is.

With the same way to the targets, forces and bounds, H and g of the first are sqrt(sigma) times
those of the second: delta_q is the same, and so are the forces lam / h.
"""

import numpy as np
import pytest

from quasistatic_ref.solve.solve import solve_step
from tests.helpers import planted_step


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("sigma", [4.0, 64.0, 1.0 / 16.0])
def test_inertia_and_time_step_are_one_number(seed, sigma):
    """sqrt(sigma) is a power of two: nothing is rounded, and every bit is the same."""
    step = planted_step(np.random.default_rng(seed))[0]
    heavy = solve_step(step.replace(M_u=sigma * step.M_u), fast=True)
    short = solve_step(step.replace(h=step.h / np.sqrt(sigma)), fast=True)
    np.testing.assert_array_equal(heavy.delta_q, short.delta_q)
    np.testing.assert_array_equal(heavy.wrench, short.wrench)
