"""Smoothed derivatives as kappa goes to zero: their bias, and no noise in its place."""

import numpy as np
import pytest

import quasistatic_ref as qr


@pytest.fixture(scope="module")
def pinched():
    """A settled step of the pinch: simulator, q, target, and its exact derivatives."""
    scenario = qr.load_scenario("two_finger_pinch", steps=40, fast=True)
    simulator, q = scenario.simulator(), scenario.run().q[38]
    target = scenario.targets(39 * scenario.h)
    return simulator, q, target, qr.derivatives(simulator, q, target)


def off(found, expected):
    """The largest error of derivatives, over the largest of them."""
    return np.abs(found - expected).max() / np.abs(expected).max()


@pytest.mark.parametrize("kappa", [1e-12, 1e-16, 1e-20, 1e-30])
def test_derivatives_tend_to_the_exact_ones_with_kappa_as_far_as_it_goes(pinched, kappa):
    """The bias is proportional to kappa, down to rounding."""
    simulator, q, target, exact = pinched
    smooth = qr.smoothed(simulator, q, target, kappa)
    for name in ("dq_dq", "dq_dq_bar_a", "dq_dtau"):
        assert off(getattr(smooth, name), getattr(exact, name)) <= 1e10 * kappa + 1e-8


def test_how_large_the_bias_of_a_kappa_is_as_the_page_says(pinched):
    simulator, q, target, exact = pinched
    for kappa, bias in ((1e-8, 0.66), (1e-10, 0.066), (1e-12, 7.2e-4)):
        smooth = qr.smoothed(simulator, q, target, kappa)
        assert off(smooth.dq_dq_bar_a, exact.dq_dq_bar_a) == pytest.approx(bias, rel=0.02)


def test_a_kappa_that_pushes_bodies_out_of_range_is_refused(pinched):
    simulator, q, target, _ = pinched
    with pytest.raises(qr.InputError, match="kappa: is so large"):
        qr.smoothed(simulator, q, target, 1e300)
