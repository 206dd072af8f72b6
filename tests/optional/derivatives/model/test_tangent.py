"""Derivatives of (+) and (-): the series of a turn, and random changes."""

import numpy as np
import pytest

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.optional.derivatives.model.tangent import difference_rates, sum_rates
from tests.closeness import assert_within
from tests.oracles.differences import rate
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
    by_q, by_x = sum_rates(system.joints, x)
    end = system.integrate(q, x)
    apart = system.difference(q, other)
    by_start, by_end = difference_rates(system.joints, apart)

    add, difference = system.integrate, system.difference
    expected = [
        rate(lambda t: difference(end, add(add(q, t * e), x))),
        rate(lambda t: difference(end, add(q, x + t * e))),
        rate(lambda t: difference(add(q, t * e), other)),
        rate(lambda t: difference(q, add(other, t * e))),
    ]
    assert_within(np.stack([by_q, by_x, by_start, by_end]) @ e, expected, DIFFERENCE)
