"""The barrier's Newton method alone: a closed form at every size, a row at rest, too few steps."""

import numpy as np
import pytest

from quasistatic_ref.optional.derivatives.step.barrier import barrier_step
from tests.helpers import changed, point_on_floor, random_step
from tests.tolerances import CLOSED_FORM

H_OF_POINT = 0.01
"""h [s]."""


def pressed(m, force, kappa):
    """A point that a force presses onto a floor without friction, and its displacement.

    Of its four equal rows each pushes with kappa / z: m z / h + h force = 4 kappa / z.
    """
    step = point_on_floor(m, 0.0, force=(0.0, 0.0, -force), h=H_OF_POINT)
    a = m / H_OF_POINT
    b = H_OF_POINT * force
    c = -int(step.counts[0]) * kappa
    return step, np.array([0.0, 0.0, -2 * c / (b + np.sqrt(b * b - 4 * a * c))])


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e-12, 1e12])
def test_a_pressed_point_hovers_at_the_root_of_its_balance_at_any_size(scale):
    kappa = 1e-4 * scale
    step, z = pressed(0.3 * scale, 2.0 * scale, kappa)
    found = barrier_step(step, kappa)
    np.testing.assert_allclose(found.x, z, rtol=CLOSED_FORM, atol=0.0)
    np.testing.assert_allclose(found.lam, kappa / found.slack, rtol=CLOSED_FORM)


def test_rows_that_are_far_push_as_little_as_kappa_says(rng):
    # lam = kappa / slack, of 1e-30 or less: far below the rounding of the loads, and yet known.
    step = random_step(rng)
    found = barrier_step(step.replace(contacts=changed(step.contacts, phi=[1.0, 2.0, 3.0])), 1e-30)
    np.testing.assert_allclose(found.lam, 1e-30 / found.slack, rtol=CLOSED_FORM)
