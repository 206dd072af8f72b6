"""Closed forms of docs/derivations.md: the claims of `validate`, and what has no claim."""

import numpy as np
import pytest

from quasistatic_ref import coulomb_step
from quasistatic_ref.lab.claims.claim import HOLDS, claim_result
from quasistatic_ref.lab.claims.registry import CLAIMS
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.lab.thresholds import exact
from tests.analytic.instances import INSTANCES, instances, log, near

LONG = (
    *("lift", "patch_torsion", "planar_push", "pushed_block"),  # a second or two
    # Whole scenarios are compared with these: sphere_spin, two_finger_pinch and block_incline.
    *("spinning_sphere_recurrence", "pinch", "incline_sliding"),
)
"""Claims that README's line leaves out."""
EACH = [
    pytest.param(name, marks=pytest.mark.long if name in LONG else ())
    for name in CLAIMS["Closed forms"]
]


@pytest.mark.parametrize("name", EACH)
def test_a_claim_holds(name):
    claim = claim_result(CLAIMS["Closed forms"][name])
    assert claim.verdict == HOLDS, [c.what for c in claim.comparisons if not c.holds]


def test_r39_given_equal_loads(rng, both):
    """Mu N r times the mean of max(|cos|, |sin|) of the angles of the slips to the tangents."""
    for _, h, mu, _ in instances(rng):
        n = 2 * int(rng.integers(1, 10))
        slip = rng.uniform(0, 2 * np.pi) + 2 * np.pi * np.arange(n) / n
        r = log(rng, 1e-3, 0.1)
        N = log(rng, 0.1, 100)
        J = np.zeros((n, 4, n + 1))  # how far each point has come off its spring, and the turn
        J[np.arange(n), 2, np.arange(n)] = 1.0
        J[:, :2, n] = r * np.column_stack([np.cos(slip), np.sin(slip)])
        contacts = contacts_of(0.0, np.tile(np.eye(3), (n, 1, 1)), J, mu)
        factor = np.maximum(np.abs(np.cos(slip)), np.abs(np.sin(slip))).mean()
        assert 1 / np.sqrt(2) - 1e-9 <= factor <= 1
        share = rng.choice([0.999, 1.001])
        load = [*np.full(n, -N / n), share * mu * N * r * factor]
        both(share > 1)
        moved = exact(free_step(np.eye(n + 1), load, contacts, h)).delta_q
        assert bool(moved[n]) == (share > 1)


def test_r38_coulombs_law_leaves_a_rigid_guide_open(rng, both):
    """On a rail whose pressure nothing else fixes, every slip up to h^2 F / m is a solution."""
    for m, h, mu, _ in instances(rng, INSTANCES // 2):
        F = log(rng, 0.1, 1e3)
        start = mu * h**2 * F / m * rng.choice([0.0, 0.3, 2.0])
        rail = contacts_of(0.0, np.eye(3), [[[1.0], [0.0], [0.0], [0.0]]], mu)
        answer = coulomb_step(free_step([[m]], [F], rail, h), fast=True, start=[start])
        slid = min(start / mu, h**2 * F / m)
        both(slid > 0)
        assert answer.converged
        near(answer.delta_q, [slid], h**2 * F / m)
        near(answer.wrench[0, 0], -(F - m * slid / h**2), F)
