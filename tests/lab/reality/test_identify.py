"""Friction from loads: planted ratios, Fisher information, and what may not be read."""

import numpy as np
import pytest

from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.identify import (
    concentration,
    cosines,
    fisher_information,
    identified_ratio,
    limit_surface,
    lost_share,
)
from quasistatic_ref.lab.reality.loads import Loads, loads_read
from quasistatic_ref.lab.reality.pairs import pairs_read

RHO = 0.04
RATIO = 0.03


def planted_loads(count, noise, seed, ratio=RATIO):
    """Loads of all directions, and twists along (f, tau / ratio^2) in a scatter of an angle."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 2 * np.pi, count)
    arm = rng.uniform(-0.06, 0.06, count)
    wrench = (
        np.column_stack([np.cos(angle), np.sin(angle), arm]) * rng.uniform(1, 3, count)[:, None]
    )
    law = wrench * [1, 1, RHO / ratio**2]
    law /= np.linalg.norm(law, axis=1, keepdims=True)
    twist = law + noise * rng.normal(size=law.shape)
    return Loads(wrench, twist / [1, 1, RHO] * rng.uniform(0.1, 2, count)[:, None])


@pytest.mark.parametrize("ratio", [0.005, RATIO, 0.2])
def test_loads_without_scatter_give_the_planted_ratio(ratio):
    found = identified_ratio(planted_loads(50, 0.0, 1, ratio), RHO)
    assert found.ratio == pytest.approx(ratio, rel=1e-6)
    assert found.reverse == pytest.approx(ratio, rel=1e-6)


def test_intervals_hold_the_planted_ratio_as_often_as_they_say():
    runs = [identified_ratio(planted_loads(300, 0.2, seed), RHO) for seed in range(20)]
    by_fisher = sum(run.low < RATIO < run.high for run in runs)
    by_draws = sum(run.drawn_low < RATIO < run.drawn_high for run in runs)
    # Of 20 intervals of 95 % fewer than 16 hold it once in 400 times: a binomial sum.
    assert min(by_fisher, by_draws) >= 16
    assert all(run.identifiable for run in runs)


def test_loads_through_the_centre_do_not_decide_the_ratio():
    loads = planted_loads(200, 0.1, 3)
    loads.wrench[:, 2] = 0.0
    loads.twist[:, 2] *= 0.1
    assert not identified_ratio(loads, RHO).identifiable


def test_few_loads_identify_nothing():
    assert identified_ratio(planted_loads(9, 0.0, 0), RHO) is None


def test_the_information_is_the_curvature_of_the_likelihood():
    # In a scatter without bias, u = A(kappa) m on average: the curvature of kappa sum u . m.
    loads = planted_loads(100, 0.0, 5)
    step = 1e-3
    wrench = loads.wrench
    law = wrench * [1, 1, RHO / RATIO**2]
    own = Loads(wrench, law / [1, 1, RHO])
    total = [cosines(own, RATIO * np.exp(d), RHO).sum() for d in (-step, 0.0, step)]
    curvature = -(total[0] - 2 * total[1] + total[2]) / step**2
    scattered = Loads(wrench, planted_loads(100, 0.1, 5).twist)
    mean = cosines(scattered, RATIO, RHO).mean()
    expected = concentration(mean) * mean * curvature
    assert fisher_information(scattered, RATIO, RHO) == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("kappa", [0.5, 3.0, 200.0])
def test_the_concentration_inverts_the_mean_cosine(kappa):
    assert concentration(1 / np.tanh(kappa) - 1 / kappa) == pytest.approx(kappa, rel=1e-9)


GAUGES = {
    "ellipsoid": lambda f, g, t: np.sqrt(f**2 + g**2 + t**2),
    "pyramid": lambda f, g, t: abs(f) + abs(g) + abs(t),
    "product": lambda f, g, t: np.maximum(abs(f) + abs(g), abs(t)),
}
SUPPORTS = {
    "ellipsoid": lambda u, v, w: np.sqrt(u**2 + v**2 + w**2),
    "pyramid": lambda u, v, w: np.max([abs(u), abs(v), abs(w)], axis=0),
    "product": lambda u, v, w: np.maximum(abs(u), abs(v)) + abs(w),
}


@pytest.mark.parametrize("cone", GAUGES)
def test_gauge_and_support_function_are_those_of_the_formulas(cone):
    rows = np.random.default_rng(0).normal(size=(200, 3))
    gauge, support = limit_surface(cone)
    assert gauge(rows) == pytest.approx(GAUGES[cone](*rows.T), rel=1e-9)
    assert support(rows) == pytest.approx(SUPPORTS[cone](*rows.T), rel=1e-9)


def test_no_dissipation_is_lost_where_the_motion_is_normal_to_the_surface():
    # On the face of the octahedron whose normal is (1, 1, 1) / sqrt(3), in units of mu_omega.
    loads = Loads(np.array([[0.2, 0.3, 0.5 * RATIO]]), np.array([[1.0, 1.0, 1.0 / RATIO]]))
    assert lost_share(loads, RATIO, *limit_surface("pyramid")) == pytest.approx([0.0], abs=1e-12)
    # At a corner of it the motion is free within its normal cone; elsewhere a share is lost.
    slid = Loads(np.array([[0.2, 0.3, 0.5 * RATIO]]), np.array([[1.0, 0.0, 0.0]]))
    assert lost_share(slid, RATIO, *limit_surface("pyramid")) == pytest.approx([0.8])


def test_a_ratio_is_near_the_published_one():
    """The published ellipsoid was fitted to the same loads by another loss."""
    (pair,) = pairs_read(reality_folder(), ["abs/rect1"])
    loads = loads_read(reality_folder(), [pair])["abs/rect1"]
    ratio = identified_ratio(loads, pair.outline.gyration).ratio
    assert ratio == pytest.approx(pair.published, rel=0.2)
