"""Closed forms of docs/derivations.md: the claims of `validate`, and what has no claim."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import coulomb_step
from quasistatic_ref.lab.claims.claim import HOLDS, claim_result
from quasistatic_ref.lab.claims.registry import CLAIMS
from tests.analytic.instances import INSTANCES, exact, instances, log, near
from tests.made import X, Y, Z, contacts_of, free_step, rigid_step

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


def ring_turns(slip, frames, share, rng):
    """Whether points that springs press alike give way to a share of mu N r."""
    _, h, mu, r = next(instances(rng))
    N = log(rng, 0.1, 100)
    n = len(slip)
    J = np.zeros((n, 4, n + 1))  # how far each point has come off its spring, and the turn
    J[np.arange(n), 2, np.arange(n)] = 1.0
    J[:, :3, n] = r * slip
    load = [*np.full(n, -N / n), share * mu * N * r]
    step = free_step(np.eye(n + 1), load, contacts_of(0.0, frames, J, mu), h)
    return bool(exact(step).delta_q[n])


def test_r39_given_equal_loads(rng):
    """Mu N r times the mean of max(|cos|, |sin|) of the angles of the slips to the tangents."""
    for _ in range(INSTANCES):
        n = 2 * int(rng.integers(1, 10))
        angle = rng.uniform(0, 2 * np.pi) + 2 * np.pi * np.arange(n) / n
        slip = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
        held = np.abs(slip).max(axis=1).mean()
        along_axes = np.tile(np.eye(3), (n, 1, 1))
        for part in (0.999, 1.001):
            assert ring_turns(slip, along_axes, part * held, rng) == (part > 1)


@pytest.mark.parametrize(("points", "share"), [(8, 0.906), (16, 0.902), (64, 0.900)])
def test_r15_needs_d1_along_the_slip(points, share, rng):
    """Then all of mu N r is held; by tangents along the world's axes, as of (R39), a share."""
    angle = 2 * np.pi * (np.arange(points) + 0.25) / points
    slip = np.column_stack([-np.sin(angle), np.cos(angle), 0 * angle])
    assert np.abs(slip).max(axis=1).mean() == pytest.approx(share, abs=5e-4)
    along_slip = np.stack([slip, np.cross(Z, slip), np.tile(Z, (points, 1))], axis=1)
    for part in (0.999, 1.001):
        assert ring_turns(slip, along_slip, part, rng) == (part > 1)


def test_r17_the_height_of_the_centre_of_mass(rng):
    """A peg whose centre of mass is c above the middle of its two contacts."""
    for m, h, mu, d in instances(rng):
        depth = rng.uniform(1.05, 6) * mu * d
        c = rng.uniform(-2, 2) * depth
        inertia = rng.uniform(1, 4) * m * (depth + d + abs(c)) ** 2
        F = log(rng, 0.1, 100)
        points = [[-d / 2, 0.0, depth / 2 - c], [d / 2, 0.0, -depth / 2 - c]]
        frames = [[Y, Z, X], [Y, -Z, -X]]
        step = rigid_step(m, inertia, (0, 0, -F, 0, 0, 0), points, frames, mu_v=mu, h=h)
        answer = exact(step)
        assert (answer.wrench[:, 2] > 0).all()
        s = (
            h**2
            * F
            / (m * (1 + (mu * (mu * d - 2 * c) / depth) ** 2) + 4 * inertia * mu**2 / depth**2)
        )
        near(answer.delta_q[[2, 4]], [-s, 2 * mu * s / depth], s * max(1, 1 / depth))


def test_r28_pi_has_the_speed_of_the_limit_surface(rng):
    """In steady motion chi~ is that of Pi = sqrt(v^2 + chi^2 omega^2) / (mu g h)."""
    for m, h, mu, chi in instances(rng, 10):
        rho = rng.uniform(0.3, 3) * chi
        g = 9.81
        v = log(rng, 1e-3, 1) * mu * g * h * h
        omega = rng.uniform(0.2, 2) * v / chi
        size = np.hypot(v, chi * omega)
        friction = mu * m * g / size
        F = (m / h**2 + friction) * v
        torque = (m * rho**2 / h**2 + friction * chi**2) * omega
        step = rigid_step(
            m, m * rho**2, (F, 0, -m * g, 0, 0, torque), [[0, 0, 0]], [np.eye(3)],
            mu_v=mu, mu_omega=mu * chi, rows=6, h=h, phi=mu * size,
        ).replace(cone="ellipsoid")  # fmt: skip
        moved = exact(step).delta_q
        near(moved[[0, 2]], [v, 0.0], size)
        Pi = np.hypot(moved[0], chi * moved[5]) / h / (mu * g * h)
        squared = (chi**2 + Pi * rho**2) / (1 + Pi)
        near(torque / F * moved[0] / moved[5], squared, squared)


def test_as_h_goes_to_0_a_free_body_becomes_a_wall():
    """A finger on a spring, whose target is e past a free block: N goes to K e, as at a wall."""
    K, m, gap, e = 500.0, 0.5, 1e-3, 3e-3
    J = [[[0.0, 0.0], [0.0, 0.0], [-1.0, 1.0], [0.0, 0.0]]]
    step = qr.StepData(
        h=1.0, K_q=[[K]], M_u=[[m]], tau_a=[0.0], tau_u=[0.0], delta_q_bar_a=[gap + e],
        contacts=contacts_of(gap, [np.eye(3)], J, 0.0),
    )  # fmt: skip
    for h in 10.0 ** -np.arange(1, 7):
        answer = exact(step.replace(h=h))
        block = K * e / (K + m / h**2)
        near(answer.delta_q, [gap + block, block], gap)
        near(answer.wrench[0, 2], K * (e - block), K * e)
    assert block < 1e-8


def test_r38_coulombs_law_leaves_a_rigid_guide_open(rng):
    """On a rail whose pressure nothing else fixes, every slip up to h^2 F / m is a solution."""
    slides = set()
    for m, h, mu, _ in instances(rng, INSTANCES // 2):
        F = log(rng, 0.1, 1e3)
        start = mu * h**2 * F / m * rng.choice([0.0, 0.3, 2.0])
        rail = contacts_of(0.0, np.eye(3), [[[1.0], [0.0], [0.0], [0.0]]], mu)
        answer = coulomb_step(free_step([[m]], [F], rail, h), "daqp", start=[start])
        slid = min(start / mu, h**2 * F / m)
        slides.add(slid > 0)
        assert answer.converged
        near(answer.delta_q, [slid], h**2 * F / m)
        near(answer.wrench[0, 0], -(F - m * slid / h**2), F)
    assert len(slides) == 2
