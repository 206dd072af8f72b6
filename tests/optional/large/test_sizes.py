"""Sizes of the terms of sums, and how far rounding moves these: against their formulas."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref.optional.large import sizes as of
from quasistatic_ref.optional.large.sizes import TINY, UNIT, rounding, sizes_of
from quasistatic_ref.step.cones import cone_function
from tests.helpers import in_blocks, random_step

CONES = ["pyramid", "product", "facets-4", "facets-8", "frictionless"]


def test_the_unit_is_the_largest_relative_error_of_one_operation():
    exact = Fraction(1) + Fraction(1, 2**53)
    lost = exact - Fraction(1.0 + 2.0**-53)
    assert lost / exact <= Fraction(UNIT) < 2 * lost


@pytest.mark.parametrize("terms", [0, 1, 30, 10_000, 1_000_000])
def test_a_bound_is_not_below_gamma_over_one_minus_gamma(terms):
    u = Fraction(1, 2**53)
    D = terms + 10
    gamma = D * u / (1 - D * u)
    for size in (1.0, 0.1, 3e-300, 1e300, 0.0):
        (found,) = rounding(terms, np.array([size]))
        exact = gamma / (1 - gamma) * Fraction(size)
        assert exact <= Fraction(found) <= exact * (1 + Fraction(1, 2**40)) + 2 * Fraction(TINY)


def test_sizes_are_the_sums_of_the_sizes_of_all_terms():
    for cone in CONES:
        step = random_step(np.random.default_rng(2)).replace(cone=cone)
        sparse = in_blocks(step)
        sizes = sizes_of(sparse, np.full(step.n_v, 0.5), 0.25, 2.0)
        c, rng = step.contacts, np.random.default_rng(3)
        x, lam = rng.standard_normal(step.n_v), rng.random(step.mask.sum())
        parts = [np.abs(axis)[:, None] @ np.abs(c.J[:, :3]) for axis in (c.n, c.d1, c.d2)]
        own = [p[:, 0] for p in parts] + [np.abs(c.J[:, 3])]
        scaled = [own[0], *(c.mu[:, i, None] * own[i + 1] for i in range(3))]
        cones = np.abs(np.stack(cone_function(cone)(*np.eye(4))))
        bar = np.einsum("ri,icv->crv", cones, scaled)[step.mask] * 2.0  # S / ell
        np.testing.assert_allclose(sizes.rows(x), bar @ np.abs(x), rtol=1e-14)
        np.testing.assert_allclose(sizes.columns(lam), bar.T @ lam, rtol=1e-14)
        spring = np.abs(step.K_q) @ np.abs(step.delta_q_bar_a) + np.abs(step.tau_a)
        load = step.h * np.concatenate([spring, np.abs(step.tau_u)]) * 0.25  # S / rho
        np.testing.assert_allclose(sizes.load, load, rtol=1e-14)
        assert sizes.column_terms == step.mask.sum()
        assert sizes.row_terms == step.n_v
        assert sizes.usable
        far = sizes_of(sparse, np.full(step.n_v, 2.0 * of.LARGEST), 1.0, 1.0)
        assert not far.usable
