"""Two opposed soft fingers hold a bar off its axis: the least squeeze in each cone, (R21) to (R24).

The derivation is in docs/cones.md. Each finger presses with N; at rest each carries m g / 2 along
d2 and, the torque m g d being shared at will, half of it about the common normal. Below the
threshold no forces balance the bar and it slips; above they do, and rest is the only optimum.
"""

import numpy as np
import pytest

from quasistatic_ref.solve.solve import solve_step
from tests.helpers import pinch
from tests.tolerances import EXACT, THRESHOLD

M = 0.2
MU_V = 0.5
MU_OMEGA = 0.02
G = 9.81
SLIDE = M * G / (2 * MU_V)  # what the weight alone needs

THRESHOLDS = {
    "pyramid": lambda slide, spin: slide + spin,  # (R21)
    "ellipsoid": np.hypot,  # (R22)
    "product": max,  # (R23)
    "facets-8": lambda slide, spin: slide + spin,  # (R24): d2 is a corner of the octagon
    "facets-6": lambda slide, spin: (
        slide / np.cos(np.pi / 6) + spin
    ),  # (R24): d2 is a side's middle
}
OFFSETS = (0.0, 0.02)


def threshold(name, d):
    """The least N that holds."""
    return THRESHOLDS[name](SLIDE, M * G * d / (2 * MU_OMEGA))


def slipped(name, d, grip):
    """Motion of the bar relative to the fingers along d2 and about the normal, at the contacts."""
    step = pinch(m=M, grip=grip, offset=d, mu_v=MU_V, mu_omega=MU_OMEGA).replace(cone=name)
    answer = solve_step(step, "clarabel")
    assert answer.certificate.kind in ("exact", "enclosure")
    motion = step.contacts.J @ answer.delta_q
    along = np.einsum("ci,ci->c", step.contacts.d2, motion[:, :3])
    return np.array([*along, *motion[:, 3]])


@pytest.mark.parametrize("name", THRESHOLDS)
@pytest.mark.parametrize("d", OFFSETS)
def test_it_slips_below_the_threshold_and_not_at_all_above_it(name, d):
    still = slipped(name, d, threshold(name, d) * (1 + THRESHOLD))
    np.testing.assert_allclose(still, 0.0, rtol=EXACT, atol=EXACT)
    assert np.abs(slipped(name, d, threshold(name, d) * (1 - THRESHOLD))).max() > 1e-12
