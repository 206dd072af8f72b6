"""Closed forms of docs/derivations.md, each against exact steps of random instances of its words.

Loads, masses, gaps and steps span decades. A formula has one side of each of its conditions in some
instances and the other side in others: `both` fails where a test saw one alone.
"""

import re
from pathlib import Path

import numpy as np

from quasistatic_ref import StepData, coulomb_step, standard_form
from quasistatic_ref.lab.claims.closed_forms.lift import MU_V, PAD, SQUEEZE, M, lifting_step
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.scenes.rigid import (
    actuated_step,
    free_step,
    point_step,
    rigid_step,
    sphere_step,
)
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.tolerances import CLOSED_FORM
from tests.analytic.instances import INFEASIBLE, INSTANCES, G, instances, log, near
from tests.closeness import assert_relative, assert_within
from tests.oracles.balance import balances
from tests.oracles.random_steps import mixed_step


def test_r1_r2_impedance(rng, both):
    """delta_q_a = delta_q_bar_a + K^-1 tau_a; against a wall N = max(0, K e + tau)."""
    for _, h, mu_v, _ in instances(rng):
        n = int(rng.integers(1, 5))
        root = rng.normal(size=(n, n))
        K = root @ root.T + np.eye(n)
        target = rng.normal(size=n)
        tau = rng.normal(size=n)
        free = actuated_step(K, tau, target, contacts_of([], np.zeros((0, 3, 3)),
                             np.zeros((0, 4, n)), mu_v), h)  # fmt: skip
        near(exact(free).delta_q, target + np.linalg.solve(K, tau), 10.0)
        k = log(rng, 1.0, 1e5)
        phi = rng.normal() * 1e-3
        e = rng.normal() * 1e-3
        load = k * rng.normal() * 1e-3
        # The coordinate moves towards the wall, against its normal.
        J = np.zeros((1, 4, 1))
        J[0, 2, 0] = -1.0
        wall = contacts_of(phi, np.eye(3)[None], J, mu_v)
        answer = exact(actuated_step([[k]], [load], [phi + e], wall, h))
        pressed = k * e + load
        both(pressed > 0)
        near(answer.wrench[0, 2], max(0.0, pressed), k * 1e-2)
        near(answer.delta_q[0], phi + min(0.0, pressed / k), 1e-2)


def test_r3_free_fall(rng):
    """The translation h^2 g, without rotation, of any body at any attitude."""
    for m, h, _, _ in instances(rng):
        c = rng.normal(size=3) * 0.1
        root = rng.normal(size=(3, 3)) * 0.1
        down = rng.normal(size=3)  # gravity in the body's frame
        down *= G / np.linalg.norm(down)
        lever = np.cross(np.eye(3), c)  # lever @ w = c x w
        at_centre = np.block([[np.eye(3), -lever], [np.zeros((3, 3)), np.eye(3)]])
        inertia = m * (root @ root.T + 0.01 * np.eye(3))
        M_u = at_centre.T @ np.block([[m * np.eye(3), np.zeros((3, 3))],
                                      [np.zeros((3, 3)), inertia]]) @ at_centre  # fmt: skip
        M_u = (M_u + M_u.T) / 2
        none = contacts_of([], np.zeros((0, 3, 3)), np.zeros((0, 4, 6)), 0.0)
        moved = exact(free_step(M_u, at_centre.T @ [*(m * down), 0, 0, 0], none, h)).delta_q
        assert_within(moved, [*(h**2 * down), 0, 0, 0], 1e-11 * h**2 * G)


def test_r4_approach_and_penetration(rng, both):
    """Dz = max(-h^2 g, -phi), N = m g - m phi / h^2 while that is positive."""
    for m, h, mu_v, _ in instances(rng):
        phi = h**2 * G * rng.uniform(-3, 3)
        answer = exact(point_step(m, (0, 0, -m * G), mu_v, phi, h))
        both(phi < h**2 * G)
        near(answer.delta_q, [0, 0, max(-(h**2) * G, -phi)], h**2 * G)
        near(answer.wrench[0, 2], max(0.0, m * G - m * phi / h**2), m * G)


def test_r5_r6_spinning_sphere(rng, both):
    """The turn of a step, and gaps max(0, phi* + (phi_0 - phi*) rho^k)."""
    for m, h, mu_v, mu_omega in instances(rng):
        inertia = m * log(rng, 1e-5, 1e-2)
        tau = mu_omega * m * G * rng.uniform(0, 3)
        fixed = mu_omega * h**2 * (tau - mu_omega * m * G) / inertia
        phi = abs(fixed) * rng.uniform(0, 2)
        rho = m * mu_omega**2 / (inertia + m * mu_omega**2)
        off = h**2 * G + mu_omega * h**2 * tau / inertia
        wrench = (0, 0, -m * G, 0, 0, tau)
        step = {"mu_v": mu_v, "mu_omega": mu_omega, "h": h}
        falls = exact(sphere_step(m, inertia, 0.05, wrench, phi=1.1 * off, **step)).delta_q
        near(falls[[2, 5]], [-(h**2) * G, h**2 * tau / inertia], np.abs(falls).max())
        phi = min(phi, 0.9 * off)
        gap = phi
        for k in (1, 2, 3):
            answer = exact(sphere_step(m, inertia, 0.05, wrench, phi=gap, **step))
            near(answer.delta_q[5], max(0.0, fixed + (gap - fixed) * rho) / mu_omega,
                 h**2 * tau / inertia + abs(fixed) / mu_omega)  # fmt: skip
            gap += answer.delta_q[2]
            expected = max(0.0, fixed + (phi - fixed) * rho**k)
            near(gap, expected, abs(fixed) + phi)
            both(tau > mu_omega * m * G, expected)


def test_r7_r9_octahedron(rng, both):
    """Held if and only if |f_1| / mu_v + |f_2| / mu_v + |tau_n| / mu_omega <= N of (R4)."""
    for m, h, mu_v, mu_omega in instances(rng):
        phi = h**2 * G * rng.uniform(-1, 0.9)
        N = m * G - m * phi / h**2
        twists = 10 ** rng.uniform(-5, -2)
        parts = rng.dirichlet(np.ones(3)) * rng.choice([-1, 1], 3) * rng.choice([0, 1], 3)
        if not parts.any():
            continue
        parts *= rng.choice([0.999, 1.001]) * N / np.abs(parts).sum()
        load = parts * [mu_v, mu_v, mu_omega]
        contact = contacts_of(phi, np.eye(3), np.eye(4)[None], mu_v, mu_omega, rows=6)
        wrench = [load[0], load[1], -m * G, load[2]]
        step = free_step(np.diag([m, m, m, m * twists]), wrench, contact, h)
        beyond = bool(np.abs(parts).sum() > N)
        both(beyond)
        assert exact(step).delta_q[[0, 1, 3]].any() == beyond
        assert balances(step, [0, 0, -phi, 0]) == (not beyond)


def test_r8_slip_of_a_point(rng, both):
    """One row, two rows, none or free; along the load only on an axis or a diagonal."""
    for m, h, mu, _ in instances(rng):
        F_1, F_2 = np.sort(m * G * mu * rng.uniform(0, 2, 2))[::-1]
        phi = h**2 * G * rng.uniform(0, 1)
        free = h**2 / m * np.array([F_1, F_2])
        one = (h**2 * (F_1 - mu * m * G) + m * mu * phi) / (m * (1 + mu**2))
        two = (h**2 * (F_1 + F_2 - mu * m * G) + m * mu * phi) / (m * (2 + mu**2))
        if phi - h**2 * G >= mu * free[0]:
            expected = free
        elif one >= free[1]:
            expected = np.array([one, free[1]])
        else:
            expected = np.full(2, max(0.0, two))
        slip = exact(point_step(m, (F_1, F_2, -m * G), mu, phi, h)).delta_q[:2]
        near(slip, expected, h**2 * G * mu)
        both(one >= free[1], two > 0)
        turned = abs(slip[0] * F_2 - slip[1] * F_1)
        assert not slip.any() or turned > 1e-9 * np.abs(slip).max() * F_1


def box(m, inertia, L, c, W):
    """The corners of a box below its centre of mass [m]; what moves it along and across."""
    return [[x, y, -c] for x in (-L, L) for y in (-W, W)]


def test_r10_r11_block_on_an_incline(rng, both):
    """It slides, dx = h^2 g (sin a - mu cos a) (1 - rho^(k+1)), tips about an edge, or stays."""
    for m, h, mu, _ in instances(rng):
        L, c, W = rng.uniform(0.02, 0.2, 3)
        inertia = m * rng.uniform(0.3, 1) * (L**2 + c**2)
        a = rng.uniform(0.02, 1.3)
        weight = (m * G * np.sin(a), 0, -m * G * np.cos(a), 0, 0, 0)
        corners = box(m, inertia, L, c, W)
        rho = mu**2 / (1 + mu**2)
        tips = np.tan(a) > L / c
        slides = np.tan(a) > mu
        both(tips, slides)
        phi = 0.0
        theta = h**2 * m * G * (c * np.sin(a) - L * np.cos(a)) / (inertia + m * (L**2 + c**2))
        f = m * G * np.sin(a) - m * c * theta / h**2
        N = m * G * np.cos(a) + m * L * theta / h**2
        if (tips and abs(f) > mu * N) or (not tips and slides and mu * c > L):
            continue  # it does both
        for k in range(2):
            step = rigid_step(m, inertia, weight, corners, [np.eye(3)] * 4, mu_v=mu, h=h, phi=phi)
            moved = exact(step).delta_q
            if tips:
                near(moved, theta * np.array([c, 0, L, 0, 1, 0]), h**2 * G * (1 + c / inertia * m))
                break
            dx = max(0.0, h**2 * G * (np.sin(a) - mu * np.cos(a)) * (1 - rho ** (k + 1)))
            near(moved, [dx, 0, mu * dx - phi, 0, 0, 0], h**2 * G * 10)
            phi = mu * dx


def test_r12_rolling_sphere(rng, both):
    """It rolls while F I / (I + m r^2) <= mu_v N."""
    for m, h, mu, _ in instances(rng):
        r = log(rng, 0.01, 1)
        inertia = m * r**2 * rng.uniform(0.1, 0.66)
        phi = h**2 * G * rng.uniform(-1, 0.9)
        N = m * G - m * phi / h**2
        F = mu * N * (inertia + m * r**2) / inertia * rng.choice([0.5, 0.999, 1.001])
        step = sphere_step(m, inertia, r, (F, 0, -m * G, 0, 0, 0), mu_v=mu, mu_omega=0.0,
                           phi=phi, h=h)  # fmt: skip
        x, _, z, _, turn, _ = exact(step).delta_q
        rolls = F * inertia / (inertia + m * r**2) <= mu * N
        both(rolls)
        theta = (h**2 * F / r) / (m + inertia / r**2)
        assert balances(step, [r * theta, 0, -phi, 0, theta, 0]) == rolls
        if rolls:
            near([x, z, r * turn], [r * theta, -phi, r * theta], h**2 * F / m + abs(phi))
        else:
            assert x > r * turn


def test_r13_pushed_block(rng):
    """Steady, N = m g, the gap mu_v v h, and the finger presses with mu_v m g + m v / h."""
    for m, h, mu, _ in instances(rng):
        v = log(rng, 1e-3, 1)
        K = log(rng, 1e2, 1e5)
        F = mu * m * G + m * v / h
        x, y, z = np.eye(3)
        J = np.zeros((2, 4, 4))  # of the finger along x, and of the block
        J[0, :3, 1:] = np.eye(3)
        J[1, :3, 1:] = np.eye(3)
        J[1, 0, 0] = -1.0
        contacts = contacts_of([mu * v * h, 0.0], [np.eye(3), [y, z, x]], J, [mu, 0.0])
        step = StepData(h, [[K]], m * np.eye(3), np.zeros(1), [0, 0, -m * G],
                        [v * h + F / K], contacts)  # fmt: skip
        answer = exact(step)
        near(answer.delta_q, [v * h, v * h, 0, 0], v * h + F / K)
        near(answer.wrench[:, 2], [m * G, F], F + m * G)


def test_r14_pinch(rng, both):
    """Held if and only if m g / (2 mu_v) + m g l / (2 mu_omega) <= N."""
    for m, _, mu_v, mu_omega in instances(rng):
        offset = rng.uniform(0, 0.1)
        grip = m * G / (2 * mu_v) + m * G * offset / (2 * mu_omega)
        for share in (0.999, 1.001):
            step = pinch_step(share * grip, offset, mu_v, mu_omega, m=m)
            moved = exact(step).delta_q
            both(moved.any())
            assert balances(step, np.zeros(step.n_v)) == (share > 1)
            assert moved.any() == (share < 1)


def test_r15_patch_of_given_loads(rng, both):
    """Points on springs of their own, pressed by N_j: the torque mu sum N_j r_j."""
    for _, h, mu, _ in instances(rng):
        n = int(rng.integers(1, 6))
        r = rng.uniform(0.001, 0.1, n)
        N = rng.uniform(0.1, 10, n)
        J = np.zeros((n, 4, n + 1))
        J[np.arange(n), 2, np.arange(n)] = 1.0
        J[:, 0, n] = r
        contacts = contacts_of(0.0, np.tile(np.eye(3), (n, 1, 1)), J, mu)
        share = rng.choice([0.999, 1.001])
        step = free_step(np.eye(n + 1), [*-N, share * mu * N @ r], contacts, h)
        both(share > 1)
        assert bool(exact(step).delta_q[n]) == (share > 1)


def test_r15_no_pressure_that_falls_outwards_gives_more_than_two_thirds(rng):
    r = (np.arange(200) + 0.5) / 200
    for _ in range(INSTANCES):
        pressure = np.sort(rng.random(200) ** rng.uniform(0, 9))[::-1]
        assert (pressure * r**2).sum() / (pressure * r).sum() <= (r**2).sum() / r.sum()


def test_r17_wedging(rng, both):
    """No descent for l < mu d; beyond, theta = 2 mu s / l, and s by the push."""
    for m, h, mu, _ in instances(rng):
        d = rng.uniform(0.01, 0.1)
        depth = mu * d * rng.choice([0.5, 0.999, 1.001, 3.0])
        height = depth * rng.uniform(1, 5)  # of a uniform rectangle
        inertia = m * (height**2 + d**2) / 12
        F = log(rng, 0.01, 1e4)
        points = [[-d / 2, 0, depth / 2], [d / 2, 0, -depth / 2]]
        x, y, z = np.eye(3)
        step = rigid_step(m, inertia, (0, 0, -F, 0, 0, 0), points, [[y, z, x], [y, -z, -x]],
                          mu_v=mu, h=h)  # fmt: skip
        moved = exact(step).delta_q
        both(depth < mu * d)
        assert balances(step, np.zeros(6)) == (depth < mu * d)
        if depth < mu * d:
            assert not moved.any()
        else:
            sideways = mu**2 * d / depth
            s = h**2 * F / (m * (1 + sideways**2) + 4 * inertia * mu**2 / depth**2)
            expected = s * np.array([-sideways, 0, -1, 0, 2 * mu / depth, 0])
            near(moved, expected, np.abs(expected).max())


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


def test_r45_inertia_and_time_step():
    """Sigma M_u at h and M_u at h / sqrt(sigma): the same delta_q, and lam sqrt(sigma) as large."""
    for seed in range(INSTANCES // 2):
        if seed in INFEASIBLE:
            continue
        step = mixed_step(seed)
        for root in (0.25, 2.0, 8.0):
            heavy = exact(step.replace(M_u=root**2 * step.M_u))
            short = exact(step.replace(h=step.h / root))
            np.testing.assert_array_equal(heavy.delta_q, short.delta_q)
            np.testing.assert_array_equal(heavy.lam, root * short.lam)


def test_the_page_of_r45_has_the_g_of_the_step():
    """(13): g = h [K_q delta_q_bar_a + tau_a; tau_u]."""
    page = (Path(__file__).parents[2] / "docs" / "artifacts.md").read_text("utf-8")
    (sign,) = re.findall(r"\$g = (-?)h\\,\[K_q\\,\\delta\\bar q_a \+ \\tau_a;\\ \\tau_u\]\$", page)
    step = mixed_step(3)
    g = step.h * np.append(step.K_q @ step.delta_q_bar_a + step.tau_a, step.tau_u)
    assert_relative(standard_form(step).g, -g if sign else g, 1e-12)


def test_r46_smallest_step_of_a_lift(rng, both):
    """The bar does not turn if and only if m (g + v / h) <= 2 mu_v N a / e."""
    limit = 2 * MU_V * SQUEEZE * PAD
    for _ in range(INSTANCES // 2):
        lever = rng.uniform(PAD, limit / (M * G) * 0.95)
        speed = log(rng, 1e-3, 1)
        rate = (limit / lever - M * G) / (M * speed)
        for share in (0.999, 1.001):
            h = 1 / (share * rate)
            step = lifting_step(speed, lever, h)
            moved = exact(step).delta_q
            assert balances(step, speed * h * np.eye(10)[[2, 3, 6]].sum(axis=0)) == (share < 1)
            turns = np.abs(moved[7:]).max() > 1e-12
            both(turns)
            assert turns == (share > 1)


def test_r38_coulombs_law_leaves_a_rigid_guide_open(rng, both):
    """On a rail whose pressure nothing else fixes, every slip up to h^2 F / m is a solution."""
    for m, h, mu, _ in instances(rng, INSTANCES // 2):
        F = log(rng, 0.1, 1e3)
        start = mu * h**2 * F / m * rng.choice([0.0, 0.3, 2.0])
        rail = contacts_of(0.0, np.eye(3), [[[1.0], [0.0], [0.0], [0.0]]], mu)
        answer = coulomb_step(free_step([[m]], [F], rail, h), fast=True, start=[start])
        slid = min(start / mu, h**2 * F / m)
        both(slid > 0)
        assert answer.found
        near(answer.delta_q, [slid], h**2 * F / m)
        near(answer.wrench[0, 0], -(F - m * slid / h**2), F)


def test_r38_locked_guide(rng, both):
    """x_1 = min(h^2 F / m, c / mu_v) along d1, and mu_v (N_1 + N_2) = F - m x_1 / h^2."""
    x, y, z = np.eye(3)
    for m, h, mu, _ in instances(rng):
        c = rng.choice([0.0, log(rng, 1e-6, 1e-2)])
        F = log(rng, 0.1, 1e5)
        walls = contacts_of(c, [[x, -z, y], [x, z, -y]], np.tile(np.eye(4, 3), (2, 1, 1)), mu)
        answer = exact(free_step(m * np.eye(3), [F, 0, 0], walls, h))
        slid = min(h**2 * F / m, c / mu)
        both(h**2 * F / m < c / mu)
        near(answer.delta_q, [slid, 0, 0], h**2 * F / m)
        near(mu * answer.wrench[:, 2].sum(), F - m * slid / h**2, F)
        push = m / h**2 * rng.normal(size=3) * c  # whatever the force
        moved = exact(free_step(m * np.eye(3), push, walls, h)).delta_q
        assert (np.abs(moved[[0, 2]]) <= c / mu * (1 + CLOSED_FORM)).all()
