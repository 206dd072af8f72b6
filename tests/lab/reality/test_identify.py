"""Friction from loads: planted ratios, and the published one."""

import numpy as np
import pytest

from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.measurements import Loads, loads_read, pairs_read

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
    assert identified_ratio(planted_loads(50, 0.0, 1, ratio), RHO) == pytest.approx(ratio, rel=1e-6)


def test_a_ratio_is_near_the_published_one():
    """The published ellipsoid was fitted to the same loads by another loss."""
    (pair,) = pairs_read(["abs/rect1"])
    ratio = identified_ratio(loads_read([pair])["abs/rect1"], pair.outline.gyration)
    assert ratio == pytest.approx(pair.published, rel=0.2)
