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
from tests.helpers import (
    JUDGE,
    REQUIRED,
    error,
    point_on_floor,
    random_step,
    sphere_on_floor,
    unconstrained,
)
from tests.tolerances import MULTIPLIERS, OPTIMUM, STICKING, TIE

G = 9.81
M, INERTIA, MU_OMEGA, MU_V, H = 0.3, 2e-4, 0.02, 0.5, 0.01
LIMIT = MU_OMEGA * M * G

every_backend = pytest.mark.parametrize("backend", [*REQUIRED, JUDGE])
every_gap = pytest.mark.parametrize("phi", [-1e-3, -1e-6, 0.0, 1e-6, 5e-4])
every_step_size = pytest.mark.parametrize("h", [0.001, 0.01, 0.1])


def spun(tau, phi=0.0, h=H):
    return sphere_on_floor(
        m=M,
        inertia=INERTIA,
        mu_v=MU_V,
        mu_omega=MU_OMEGA,
        phi=phi,
        wrench=(0, 0, -M * G, 0, 0, tau),
        h=h,
    )


def sphere_form(tau, phi=0.0, h=H):
    """(delta_z, delta_theta) of the docstring."""
    theta = (h**2 * (tau - LIMIT) + M * MU_OMEGA * phi) / (INERTIA + M * MU_OMEGA**2)
    theta = max(theta, 0.0)
    return MU_OMEGA * theta - phi, theta


def pulled(force, phi=0.0):
    return point_on_floor(m=M, mu_v=MU_V, phi=phi, force=(force, 0.0, -M * G), h=H)


@every_backend
@every_gap
@pytest.mark.parametrize("share", [1.2, 1.5, 3.0, 10.0])
def test_beyond_the_limit_the_sphere_turns_by_the_closed_form(backend, phi, share):
    limit = LIMIT - M * MU_OMEGA * phi / H**2  # mu_omega N / h of the stuck sphere
    tau = share * limit if limit > 0 else (share - 1) * LIMIT
    step = spun(tau, phi)
    z, theta = sphere_form(tau, phi)
    assert theta > 0
    truth = [0, 0, z, 0, 0, theta]
    delta_q = solve_step(step, backend).delta_q
    np.testing.assert_allclose(error(step, delta_q, truth), 0.0, rtol=0.0, atol=OPTIMUM)


@every_backend
@pytest.mark.parametrize("phi", [-1e-3, -1e-6, 0.0, 1e-6])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 0.99])
def test_below_the_limit_the_sphere_sticks(backend, phi, share):
    tau = share * (LIMIT - M * MU_OMEGA * phi / H**2)
    step = spun(tau, phi)
    delta_q = solve_step(step, backend).delta_q
    gap = error(step, delta_q, [0, 0, -phi, 0, 0, 0])
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=STICKING)


@every_backend
def test_at_the_limit_it_still_sticks(backend):
    step = spun(LIMIT)
    gap = error(step, solve_step(step, backend).delta_q, np.zeros(6))
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=TIE)


@pytest.mark.parametrize("beyond", [1e-6, 1e-4, 1e-2])
def test_sticking_ends_exactly_at_mu_omega_m_g(beyond):
    # delta_theta is compared with itself: the smallest excess torque turns by the closed form.
    turned = solve_step(spun((1 + beyond) * LIMIT), JUDGE).delta_q[5]
    np.testing.assert_allclose(
        turned, sphere_form((1 + beyond) * LIMIT)[1], rtol=MULTIPLIERS, atol=0.0
    )
    held = solve_step(spun((1 - beyond) * LIMIT), JUDGE).delta_q[5]
    np.testing.assert_allclose(held, 0.0, rtol=0.0, atol=MULTIPLIERS * turned)


@every_backend
@every_step_size
def test_the_boundary_layer_at_a_fixed_torque_is_proportional_to_h_squared(backend, h):
    # delta_z = mu_omega delta_theta from phi = 0; the paper speaks of a rate, the next test.
    step = spun(2 * LIMIT, h=h)
    lift = solve_step(step, backend).delta_q[2]
    expected = h**2 * MU_OMEGA * LIMIT / (INERTIA + M * MU_OMEGA**2)
    np.testing.assert_allclose(lift, expected, rtol=MULTIPLIERS, atol=0.0)


@every_step_size
def test_the_boundary_layer_at_a_fixed_rate_is_proportional_to_h(h):
    # Repeated, phi goes to where delta_z = 0: phi* = mu_omega delta_theta = mu_omega h |omega|.
    phi, tau = 0.0, 2 * LIMIT
    for _ in range(30):
        delta_q = solve_step(spun(tau, phi, h), JUDGE).delta_q
        phi += delta_q[2]
    np.testing.assert_allclose(phi, MU_OMEGA * delta_q[5], rtol=MULTIPLIERS, atol=0.0)
    # and (I + m mu^2) theta = h^2 (tau - limit) + m mu phi  =>  I theta = h^2 (tau - limit)
    np.testing.assert_allclose(delta_q[5], h**2 * LIMIT / INERTIA, rtol=MULTIPLIERS, atol=0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_sphere_turns_the_way_it_is_twisted(sign):
    _, theta = sphere_form(2 * LIMIT)
    turned = solve_step(spun(sign * 2 * LIMIT)).delta_q[5]
    np.testing.assert_allclose(turned, sign * theta, rtol=MULTIPLIERS, atol=0.0)


def test_without_torsional_rows_the_least_torque_turns_it():
    tau = 0.1 * LIMIT
    step = sphere_on_floor(m=M, inertia=INERTIA, wrench=(0, 0, -M * G, 0, 0, tau), rows=4)
    turned = solve_step(step).delta_q[5]
    np.testing.assert_allclose(turned, H**2 * tau / INERTIA, rtol=MULTIPLIERS, atol=0.0)


@every_backend
@every_gap
@pytest.mark.parametrize("share", [1.2, 3.0])
def test_beyond_the_limit_the_point_slides_by_the_closed_form(backend, phi, share):
    limit = MU_V * (M * G - M * phi / H**2)
    force = share * limit if limit > 0 else (share - 1) * MU_V * M * G
    step = pulled(force, phi)
    x = (H**2 * (force - MU_V * M * G) + M * MU_V * phi) / (M + M * MU_V**2)
    assert x > 0
    truth = [x, 0.0, MU_V * x - phi]
    delta_q = solve_step(step, backend).delta_q
    np.testing.assert_allclose(error(step, delta_q, truth), 0.0, rtol=0.0, atol=OPTIMUM)


@every_backend
@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_below_the_limit_the_point_sticks(backend, share):
    step = pulled(share * MU_V * M * G)
    gap = error(step, solve_step(step, backend).delta_q, np.zeros(3))
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=STICKING)


@pytest.mark.parametrize(("angle", "holds"), [(0, 0.99), (0, 1.01), (45, 0.99), (45, 1.01)])
def test_the_pyramid_is_weaker_by_the_square_root_of_two_between_its_axes(angle, holds):
    # |f_1| + |f_2| <= mu_v N: along an axis the limit is mu_v N, at 45 degrees mu_v N / sqrt 2.
    limit = MU_V * M * G / (1.0 if angle == 0 else np.sqrt(2.0))
    a, force = np.radians(angle), holds * limit
    step = point_on_floor(m=M, mu_v=MU_V, force=(force * np.cos(a), force * np.sin(a), -M * G), h=H)
    moved = np.linalg.norm(solve_step(step, JUDGE).delta_q[:2])
    if holds < 1:
        np.testing.assert_allclose(moved, 0.0, rtol=0.0, atol=STICKING * H**2 * G)
    else:
        assert moved > 1e-3 * H**2 * G


@every_backend
@pytest.mark.parametrize("m", [0.01, 0.3, 100.0])
def test_at_rest_the_multipliers_over_h_carry_the_weight(backend, m):
    # delta_q = 0, and sum(lam) / h = m g.
    for step in (
        point_on_floor(m=m, force=(0, 0, -m * G)),
        sphere_on_floor(m=m, inertia=1e-3 * m, wrench=(0, 0, -m * G, 0, 0, 0)),
    ):
        answer = solve_step(step, backend)
        np.testing.assert_allclose(answer.lam.sum() / step.h, m * G, rtol=MULTIPLIERS, atol=0.0)
        np.testing.assert_allclose(answer.wrench[0, 2], m * G, rtol=MULTIPLIERS, atol=0.0)
        gap = error(step, answer.delta_q, np.zeros(step.n_v))
        np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=STICKING)


@every_backend
@pytest.mark.parametrize("phi", [-1e-3, -1e-5])
def test_penetration_is_pushed_out_by_m_g_plus_m_phi_over_h_squared(backend, phi):
    step = point_on_floor(m=M, phi=phi, force=(0, 0, -M * G), h=H)
    answer = solve_step(step, backend)
    np.testing.assert_allclose(answer.delta_q[2], -phi, rtol=OPTIMUM, atol=0.0)
    expected = M * G + M * abs(phi) / H**2
    np.testing.assert_allclose(answer.wrench[0, 2], expected, rtol=MULTIPLIERS, atol=0.0)


@every_backend
def test_free_fall_is_minus_h_squared_g_in_every_step(backend):
    step = point_on_floor(m=M, phi=1.0, force=(0, 0, -M * G), h=H)
    truth = [0, 0, -(H**2) * G]
    gap = error(step, solve_step(step, backend).delta_q, truth)
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=OPTIMUM)


@every_backend
@pytest.mark.parametrize("seed", range(3))
def test_a_free_impedance_moves_by_its_target_and_tau_a_over_the_stiffness(backend, seed):
    # h K dq - h (K dq_bar + tau_a) = 0: delta_q_a = delta_q_bar_a + K_q^-1 tau_a.
    step = random_step(np.random.default_rng(seed), 4, 0, rows=())
    answer = solve_step(step, backend)
    left = step.K_q @ (answer.delta_q - step.delta_q_bar_a)
    scale = np.abs(step.tau_a).max()
    np.testing.assert_allclose(left, step.tau_a, rtol=0.0, atol=MULTIPLIERS * scale)


@every_backend
@pytest.mark.parametrize("seed", range(3))
def test_a_free_body_moves_by_h_squared_over_its_mass_times_the_force(backend, seed):
    # M dq / h - h tau_u = 0: delta_q_u = h^2 M_u^-1 tau_u.
    step = random_step(np.random.default_rng(seed), 0, 4, rows=())
    answer = solve_step(step, backend)
    left = step.M_u @ answer.delta_q / step.h**2
    scale = np.abs(step.tau_u).max()
    np.testing.assert_allclose(left, step.tau_u, rtol=0.0, atol=MULTIPLIERS * scale)


@every_backend
def test_actuated_and_unactuated_do_not_mix_without_contact(backend, rng):
    step = random_step(rng, 3, 4, rows=())
    gap = error(step, solve_step(step, backend).delta_q, unconstrained(step))
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=OPTIMUM)
