"""Derivatives of (+) and (-): the series of a turn, and random changes."""

import numpy as np
import pytest

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.optional.derivatives.model.tangent import (
    adjoint,
    difference_rates,
    right_jacobian,
    sum_rates,
)
from tests.closeness import assert_within
from tests.tolerances import DIFFERENCE, FOUR_ULP


@pytest.mark.parametrize("angle", [1e-3, 1.1, 3.0])
def test_the_series_of_a_turn_is_summed_to_its_last_digits(angle):
    # About z: J_xx = J_yy = sin(a) / a, J_xy = -J_yx = (1 - cos(a)) / a = 2 sin(a / 2)^2 / a.
    along = np.sin(angle) / angle
    across = 2 * np.sin(angle / 2) ** 2 / angle
    turn = np.array([[along, across, 0], [-across, along, 0], [0, 0, 1]])
    jacobian = right_jacobian(adjoint(np.array([0, 0, 0, 0, 0, angle])))
    assert_within(jacobian, np.kron(np.eye(2), turn), FOUR_ULP)


@pytest.mark.parametrize("base", ["floating", "planar", "ball"])
@pytest.mark.parametrize("seed", range(5))
def test_r30_sums_and_differences_change_as_written(seed, base):
    """By differences of the screws themselves, turns being below pi."""
    rng = np.random.default_rng(seed)
    system = System([Body.of_shape("b", Sphere(0.1), 1.0, base=base)])
    n = system.n_v
    q, other = (system.integrate(system.neutral(), rng.normal(size=n)) for _ in range(2))
    x, e = rng.normal(size=(2, n))
    e *= 1e-6
    by_q, by_x = sum_rates(system.joints, x)
    end = system.integrate(q, x)
    apart = system.difference(q, other)
    by_start, by_end = difference_rates(system.joints, apart)

    def rate(function):
        return (function(e) - function(-e)) / 2e-6

    moved = rate(lambda t: system.difference(end, system.integrate(system.integrate(q, t), x)))
    changed = rate(lambda t: system.difference(end, system.integrate(q, x + t)))
    first = rate(lambda t: system.difference(system.integrate(q, t), other))
    last = rate(lambda t: system.difference(q, system.integrate(other, t)))
    rates = np.stack([by_q, by_x, by_start, by_end]) @ (e / 1e-6)
    assert_within(rates, [moved, changed, first, last], DIFFERENCE)
