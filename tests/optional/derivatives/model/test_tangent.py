"""Derivatives of (+) and (-): the series of a turn, and random changes."""

import numpy as np
import pytest

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.optional.derivatives.model.tangent import difference_rates, sum_rates
from tests.closeness import assert_within
from tests.tolerances import DIFFERENCE


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
