"""Closed forms of one step: a spinning sphere, a sliding point, a spring, a fall, a rest.

The spinning sphere. A sphere (m, I) over a floor at signed distance phi is loaded with its weight
and a torque tau >= 0 about the normal. By symmetry it only rises by delta_z and turns by
delta_theta; its rows (4) become

    phi + delta_z >= 0 (the four tangential rows),
    phi + delta_z + mu_omega delta_theta >= 0,      phi + delta_z - mu_omega delta_theta >= 0,

and (13) is  m/2h delta_z^2 + I/2h delta_theta^2 + h m g delta_z - h tau delta_theta.

Stuck. With delta_theta = 0, delta_z = -phi the normal impulse is N = h m g - m phi / h, and the
spin rows carry h tau: possible if and only if |h tau| <= mu_omega N, with phi = 0 tau <= mu_omega
m g.

Turning. The last row is active with impulse N:
    m delta_z / h + h m g = N,   I delta_theta / h - h tau = -mu_omega N,
    delta_z = mu_omega delta_theta - phi;
eliminating N and delta_z,
    delta_theta = [h^2 (tau - mu_omega m g) + m mu_omega phi] / (I + m mu_omega^2),
positive exactly where sticking is impossible. It holds while N >= 0.

The sliding point is the same with delta_x, mu_v, F and m in place of delta_theta, mu_omega, tau, I.
"""

import numpy as np
import pytest

from quasistatic_ref.solve.solve import solve_step
from tests.helpers import error, point_on_floor, random_step, sphere_on_floor, unconstrained
from tests.tolerances import MULTIPLIERS, OPTIMUM, STICKING

G = 9.81
M, INERTIA, MU_OMEGA, MU_V, H = 0.3, 2e-4, 0.02, 0.5, 0.01
LIMIT = MU_OMEGA * M * G

every_gap = pytest.mark.parametrize("phi", [-1e-3, -1e-6, 0.0, 1e-6, 5e-4])
every_step_size = pytest.mark.parametrize("h", [0.001, 0.01, 0.1])


def spun(tau, phi=0.0, h=H, rows=6):
    load = (0, 0, -M * G, 0, 0, tau)
    return sphere_on_floor(M, INERTIA, 0.04, MU_V, MU_OMEGA, phi, load, h, rows)


def turn(tau, phi=0.0, h=H):
    """delta_theta of the docstring."""
    theta = (h**2 * (tau - LIMIT) + M * MU_OMEGA * phi) / (INERTIA + M * MU_OMEGA**2)
    return max(theta, 0.0)


def pulled(force, phi=0.0, angle=0.0):
    along = (force * np.cos(angle), force * np.sin(angle))
    return point_on_floor(m=M, mu_v=MU_V, phi=phi, force=(*along, -M * G), h=H)


def assert_moves(step, truth, tolerance=OPTIMUM):
    """The answer of a step is this motion, in the one definition of error; it is returned."""
    answer = solve_step(step, "none")
    gap = error(step, answer.delta_q, truth)
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=tolerance)
    return answer


@every_gap
@pytest.mark.parametrize("share", [-3.0, 1.2, 10.0])
def test_beyond_the_limit_the_sphere_turns_by_the_closed_form(phi, share):
    limit = LIMIT - M * MU_OMEGA * phi / H**2  # mu_omega N / h of the stuck sphere
    tau = abs(share) * limit if limit > 0 else (abs(share) - 1) * LIMIT
    theta = turn(tau, phi)
    assert theta > 0
    assert_moves(spun(np.sign(share) * tau, phi), [0, 0, MU_OMEGA * theta - phi, 0, 0,
                                                    np.sign(share) * theta])  # fmt: skip


@pytest.mark.parametrize("phi", [-1e-3, 0.0, 1e-6])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.99])
def test_below_the_limit_the_sphere_sticks(phi, share):
    tau = share * (LIMIT - M * MU_OMEGA * phi / H**2)
    assert_moves(spun(tau, phi), [0, 0, -phi, 0, 0, 0], STICKING)


@pytest.mark.parametrize("beyond", [0.0, 1e-6, 1e-2])
def test_sticking_ends_exactly_at_mu_omega_m_g(beyond):
    # delta_theta is compared with itself: the smallest excess torque turns by the closed form.
    expected = turn((1 + beyond) * LIMIT)
    turned = solve_step(spun((1 + beyond) * LIMIT), "none").delta_q[5]
    np.testing.assert_allclose(turned, expected, rtol=MULTIPLIERS, atol=1e-16)
    assert_moves(spun((1 - beyond) * LIMIT), np.zeros(6), STICKING * beyond + 1e-16)


@every_step_size
def test_the_boundary_layer_at_a_fixed_torque_is_proportional_to_h_squared(h):
    # delta_z = mu_omega delta_theta from phi = 0; the paper speaks of a rate, the next test.
    lift = solve_step(spun(2 * LIMIT, h=h), "none").delta_q[2]
    expected = h**2 * MU_OMEGA * LIMIT / (INERTIA + M * MU_OMEGA**2)
    np.testing.assert_allclose(lift, expected, rtol=MULTIPLIERS, atol=0.0)


@every_step_size
def test_the_boundary_layer_at_a_fixed_rate_is_proportional_to_h(h):
    # Repeated, phi goes to where delta_z = 0: phi* = mu_omega delta_theta = mu_omega h |omega|.
    phi, tau = 0.0, 2 * LIMIT
    for _ in range(30):
        delta_q = solve_step(spun(tau, phi, h), "none").delta_q
        phi += delta_q[2]
    np.testing.assert_allclose(phi, MU_OMEGA * delta_q[5], rtol=MULTIPLIERS, atol=0.0)
    # and (I + m mu^2) theta = h^2 (tau - limit) + m mu phi  =>  I theta = h^2 (tau - limit)
    np.testing.assert_allclose(delta_q[5], h**2 * LIMIT / INERTIA, rtol=MULTIPLIERS, atol=0.0)


def test_without_torsional_rows_the_least_torque_turns_it():
    tau = 0.1 * LIMIT
    assert_moves(spun(tau, rows=4), [0, 0, 0, 0, 0, H**2 * tau / INERTIA])


@every_gap
@pytest.mark.parametrize("share", [1.2, 3.0])
def test_beyond_the_limit_the_point_slides_by_the_closed_form(phi, share):
    limit = MU_V * (M * G - M * phi / H**2)
    force = share * limit if limit > 0 else (share - 1) * MU_V * M * G
    x = (H**2 * (force - MU_V * M * G) + M * MU_V * phi) / (M + M * MU_V**2)
    assert x > 0
    assert_moves(pulled(force, phi), [x, 0.0, MU_V * x - phi])


@pytest.mark.parametrize("angle", [0, 45])
def test_the_pyramid_is_weaker_by_the_square_root_of_two_between_its_axes(angle):
    # |f_1| + |f_2| <= mu_v N: along an axis the limit is mu_v N, at 45 degrees mu_v N / sqrt 2.
    limit = MU_V * M * G / (1.0 if angle == 0 else np.sqrt(2.0))
    for share in (0.0, 0.5, 0.99):
        assert_moves(pulled(share * limit, angle=np.radians(angle)), np.zeros(3), STICKING)
    moved = solve_step(pulled(1.01 * limit, angle=np.radians(angle)), "none").delta_q[:2]
    assert np.linalg.norm(moved) > 1e-3 * H**2 * G


@pytest.mark.parametrize("m", [0.01, 100.0])
def test_at_rest_the_multipliers_over_h_carry_the_weight(m):
    # delta_q = 0, and sum(lam) / h = m g.
    for step in (
        point_on_floor(m=m, force=(0, 0, -m * G)),
        sphere_on_floor(m=m, inertia=1e-3 * m, wrench=(0, 0, -m * G, 0, 0, 0)),
    ):
        answer = assert_moves(step, np.zeros(step.n_v), STICKING)
        np.testing.assert_allclose(answer.lam.sum() / step.h, m * G, rtol=MULTIPLIERS, atol=0.0)
        np.testing.assert_allclose(answer.wrench[0, 2], m * G, rtol=MULTIPLIERS, atol=0.0)


@pytest.mark.parametrize("phi", [-1e-3, -1e-5])
def test_penetration_is_pushed_out_by_m_g_plus_m_phi_over_h_squared(phi):
    answer = assert_moves(pulled(0.0, phi), [0, 0, -phi])
    expected = M * G + M * abs(phi) / H**2
    np.testing.assert_allclose(answer.wrench[0, 2], expected, rtol=MULTIPLIERS, atol=0.0)


def test_free_fall_is_minus_h_squared_g_in_every_step():
    assert_moves(pulled(0.0, phi=1.0), [0, 0, -(H**2) * G])


@pytest.mark.parametrize(("n_a", "n_u"), [(4, 0), (0, 4), (3, 4)])
def test_without_contact_impedances_and_bodies_move_each_by_their_own_load(n_a, n_u, rng):
    # h K dq - h (K dq_bar + tau_a) = 0: delta_q_a = delta_q_bar_a + K_q^-1 tau_a;
    # M dq / h - h tau_u = 0: delta_q_u = h^2 M_u^-1 tau_u.
    step = random_step(rng, n_a, n_u, rows=())
    assert_moves(step, unconstrained(step))
