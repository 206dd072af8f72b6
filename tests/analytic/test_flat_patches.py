"""(R16), (R39): the torque that points of one rigid body hold without mu_omega."""

import numpy as np
import pytest

from quasistatic_ref import solve_step
from quasistatic_ref.lab.thresholds import threshold
from tests.made import rigid_step
from tests.oracles.balance import balances

HEIGHT = 0.02
GRAVITY = 9.81
STILL = 1e-12
"""A turn below this [rad] is none."""
NEAR = 1e-3
"""How far beyond and below its limit a torque is tried, relative [-]."""


def patch_step(points, d1, held, mass=1.0, mu_v=0.5):
    """A body on such points, under a torque about its centre of mass over mu times its weight [m].

    Parameters
    ----------
    points : array_like, shape (n, 2)
        From the centre of mass, along the floor [m].
    d1 : array_like, shape (n, 2)
        Tangents; d2 is a quarter turn further.
    """
    n = len(points)
    z = np.tile([0.0, 0.0, 1.0], (n, 1))
    along = np.column_stack([d1, np.zeros(n)])
    frames = np.stack([along, np.cross(z, along), z], axis=1)
    below = np.column_stack([points, np.full(n, -HEIGHT)])
    weight = mass * GRAVITY
    wrench = (0, 0, -weight, 0, 0, held * mu_v * weight)
    return rigid_step(mass, mass * 4e-4, wrench, below, frames, mu_v=mu_v, h=0.01)


def held_torque(points, d1):
    """The largest torque, over mu times the weight, that forces in the pyramids balance [m]."""

    def slips(held):
        return not balances(patch_step(points, d1, held), np.zeros(6))

    return threshold(slips, 0.0, 2 * np.hypot(*np.transpose(points)).max(), 1e-6)


def across(points):
    """Tangents along the slip."""
    return np.column_stack([-points[:, 1], points[:, 0]]) / np.hypot(*points.T)[:, None]


def bound(points, d1):
    """max_j r_j cos eps_j [m]: the slip of a point against the nearer of its tangents."""
    along = across(points)
    cross = along[:, 0] * d1[:, 1] - along[:, 1] * d1[:, 0]
    cosine = np.maximum(np.abs((along * d1).sum(axis=1)), np.abs(cross))
    return (np.hypot(*points.T) * cosine).max()


def check(rng, points, d1, held):
    """The body does not turn a little below a torque, and turns a little beyond it."""
    body = {"mass": 10 ** rng.uniform(-1, 1), "mu_v": rng.uniform(0.1, 1)}
    for share in (1 - NEAR, 1 + NEAR):
        step = patch_step(points, d1, share * held, **body)
        turn = abs(solve_step(step, "daqp").delta_q[5])
        assert (turn > STILL) == (share > 1)


def test_three_points_that_are_not_opposite_hold_less_than_the_bound(rng):
    points = 1e-3 * np.array([[60.0, 0.0], [-30.0, 20.0], [-30.0, -20.0]])
    held = held_torque(points, across(points))
    assert [held, bound(points, across(points))] == pytest.approx([0.0383, 0.06], abs=5e-5)
    check(rng, points, across(points), held)


@pytest.mark.parametrize("opposite", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_r16_a_patch_holds_what_statics_allows_and_opposite_points_the_bound(seed, opposite):
    """Random points around the centre of mass, with random tangents; or opposite ones, with equal.

    None holds more than the bound.
    """
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(rng.integers(3, 8), 2)) * 0.03
    angle = rng.uniform(0, 2 * np.pi, len(points))
    d1 = np.column_stack([np.cos(angle), np.sin(angle)])
    if opposite:
        points, d1 = np.vstack([points, -points]), np.vstack([d1, d1])
    else:
        points -= rng.dirichlet(np.ones(len(points))) @ points
    held = held_torque(points, d1)
    most = bound(points, d1)
    assert held <= most * (1 + 1e-6)
    assert not opposite or held == pytest.approx(most, rel=1e-5)
    check(rng, points, d1, held)
