"""Smoothed derivatives as kappa goes to zero: their bias, and no noise in its place."""

import numpy as np
import pytest

import quasistatic_ref as qr


@pytest.fixture(scope="module")
def pinched():
    """A settled step of the pinch: simulator, q, target, and its exact derivatives."""
    scenario = qr.load_scenario("two_finger_pinch", steps=40, fast=True)
    simulator, q = scenario.simulator(), scenario.run(progress=False).q[38]
    target = scenario.targets(39 * scenario.h)
    return simulator, q, target, qr.derivatives(simulator, q, target)


@pytest.mark.parametrize("kappa", [1e-12, 1e-16, 1e-20, 1e-30])
def test_derivatives_tend_to_the_exact_ones_with_kappa_as_far_as_it_goes(pinched, kappa):
    """The bias is proportional to kappa, down to rounding."""
    simulator, q, target, exact = pinched
    smooth = qr.smoothed(simulator, q, target, kappa)
    for name in ("dq_dq", "dq_dq_bar_a", "dq_dtau"):
        expected = getattr(exact, name)
        off = np.abs(getattr(smooth, name) - expected).max() / np.abs(expected).max()
        assert off <= 1e10 * kappa + 1e-8


def test_how_large_the_bias_of_a_kappa_is_as_the_page_says(pinched):
    simulator, q, target, exact = pinched
    bias = {}
    for kappa in (1e-8, 1e-10, 1e-12):
        off = qr.smoothed(simulator, q, target, kappa).dq_dq_bar_a - exact.dq_dq_bar_a
        bias[kappa] = np.abs(off).max() / np.abs(exact.dq_dq_bar_a).max()
    assert bias == pytest.approx({1e-8: 0.66, 1e-10: 0.066, 1e-12: 7.2e-4}, rel=0.02)


def test_a_kappa_that_pushes_bodies_out_of_range_is_refused(pinched):
    simulator, q, target, _ = pinched
    with pytest.raises(qr.InputError, match="kappa: is so large"):
        qr.smoothed(simulator, q, target, 1e300)
