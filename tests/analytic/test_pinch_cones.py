"""Two opposed soft fingers hold a bar off its axis: the least squeeze in each cone, (R21) to (R24).

The derivation is in docs/cones.md. Each finger presses with N; at rest each carries m g / 2 along
d2 and, the torque m g d being shared at will, half of it about the common normal. Below the
threshold no forces balance the bar and it slips; above they do, and rest is the only optimum.
"""

import numpy as np
import pytest

from quasistatic_ref import solve_step
from tests.closeness import assert_same
from tests.helpers import pinch
from tests.oracles.balance import balances
from tests.tolerances import THRESHOLD

G = 9.81

THRESHOLDS = {
    "pyramid": lambda slide, spin: slide + spin,  # (R21)
    "ellipsoid": np.hypot,  # (R22)
    "product": max,  # (R23)
    "facets-8": lambda slide, spin: slide + spin,  # (R24): d2 is a corner of the octagon
    "facets-6": lambda slide, spin: (
        slide / np.cos(np.pi / 6) + spin
    ),  # (R24): d2 is a side's middle
}


def slip_at_contacts(step):
    """Motion of the bar relative to the fingers along d2 and about the normal, at the contacts."""
    answer = solve_step(step, "clarabel")
    assert answer.certificate.kind in ("exact", "enclosure")
    motion = step.contacts.J @ answer.delta_q
    along = np.einsum("ci,ci->c", step.contacts.d2, motion[:, :3])
    return np.array([*along, *motion[:, 3]])


@pytest.mark.parametrize("name", THRESHOLDS)
@pytest.mark.parametrize("seed", range(3))
def test_r21_r22_r23_r24_a_pinch_slips_below_the_threshold_and_not_above(name, seed):
    rng = np.random.default_rng(seed)
    bar = {
        "m": 10 ** rng.uniform(-2, 1),
        "offset": rng.uniform(0, 0.1) if seed else 0.0,
        "mu_v": rng.uniform(0.1, 1.5),
        "mu_omega": 10 ** rng.uniform(-2.5, -1),
    }
    slide = bar["m"] * G / (2 * bar["mu_v"])  # what the weight alone needs
    spin = bar["m"] * G * bar["offset"] / (2 * bar["mu_omega"])
    least = THRESHOLDS[name](slide, spin)
    above, below = (
        pinch(grip=least * (1 + side), **bar).replace(cone=name) for side in (THRESHOLD, -THRESHOLD)
    )
    assert_same(slip_at_contacts(above), 0.0)
    assert np.abs(slip_at_contacts(below)).max() > 1e-12
    if name != "ellipsoid":
        far = pinch(grip=least * (1 - 1e-3), **bar).replace(cone=name)
        assert [balances(step, np.zeros(step.n_v)) for step in (above, far)] == [True, False]
