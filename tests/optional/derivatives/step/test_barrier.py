"""The barrier's Newton method alone: a closed form at every size, a row at rest, too few steps."""

import numpy as np
import pytest

from quasistatic_ref import StepNotSolved, standard_form
from quasistatic_ref.optional.derivatives.step import barrier
from quasistatic_ref.optional.derivatives.step.barrier import barrier_step
from tests.closeness import assert_relative, assert_within
from tests.helpers import changed, point_on_floor, random_step
from tests.oracles.differences import rate
from tests.tolerances import ACTIVE_SET, CLOSED_FORM

H_OF_POINT = 0.01
"""h [s]."""


def pressed_point(m, force, kappa):
    """A point that a force presses onto a floor without friction, and its displacement.

    Of its four equal rows each pushes with kappa / z: m z / h + h force = 4 kappa / z.
    """
    step = point_on_floor(m, 0.0, force=(0.0, 0.0, -force), h=H_OF_POINT)
    a = m / H_OF_POINT
    b = H_OF_POINT * force
    c = -int(step.counts[0]) * kappa
    return step, np.array([0.0, 0.0, -2 * c / (b + np.sqrt(b * b - 4 * a * c))])


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e-12, 1e12])
def test_a_pressed_point_hovers_at_the_root_of_its_balance_at_any_size(scale):
    kappa = 1e-4 * scale
    step, z = pressed_point(0.3 * scale, 2.0 * scale, kappa)
    found = barrier_step(step, kappa)
    assert_relative(found.x, z, CLOSED_FORM)
    assert_relative(found.lam, kappa / found.slack, CLOSED_FORM)


@pytest.mark.parametrize("scale", [1.0, 1e-12])
def test_newton_s_method_cut_short_gives_the_minimiser_or_nothing(scale, monkeypatch):
    kappa = 1e-4 * scale
    answers = 0
    step, z = pressed_point(0.3 * scale, 2.0 * scale, kappa)
    for steps in range(30):
        monkeypatch.setattr(barrier, "STEPS", steps)
        try:
            found = barrier_step(step, kappa)
        except StepNotSolved:
            assert not answers
            continue
        assert_relative(found.x, z, ACTIVE_SET)
        answers += 1
    assert 0 < answers < 29


def test_without_rows_and_loads_nothing_moves(rng):
    step = random_step(rng, rows=())
    at_rest = step.replace(tau_a=np.zeros(3), tau_u=np.zeros(4), delta_q_bar_a=np.zeros(3))
    np.testing.assert_array_equal(barrier_step(at_rest, 1e-6).x, np.zeros(7))


def test_rows_that_are_far_push_as_little_as_kappa_says(rng):
    # lam = kappa / slack, of 1e-30 or less: far below the rounding of the loads, and yet known.
    step = random_step(rng)
    found = barrier_step(step.replace(contacts=changed(step.contacts, phi=[1.0, 2.0, 3.0])), 1e-30)
    assert_relative(found.lam, 1e-30 / found.slack, CLOSED_FORM)


@pytest.mark.parametrize("seed", range(6))
def test_r36_random_smoothed_steps_change_as_written(seed):
    """(H + A'SA) dx = d(g - Hx) + dA'lam - A'S (dA x - db), by forces, gaps and stiffness."""
    rng = np.random.default_rng(seed)
    step = random_step(rng)
    step = step.replace(contacts=changed(step.contacts, phi=rng.uniform(1e-3, 1e-2, 3)))
    kappa = 10 ** rng.uniform(-7, -4)
    found = barrier_step(step, kappa)
    H, g, A, b = standard_form(step)
    x = found.x
    assert_relative(found.lam * (A @ x - b), kappa, CLOSED_FORM)
    balance = H @ x - g - A.T @ found.lam
    assert np.abs(balance).max() < 1e-12 * (np.abs(H) @ np.abs(x) + np.abs(g)).max()
    tau_u, phi, mu_v, K = (rng.normal(size=n) for n in (step.n_u, 3, 3, step.n_a))

    def moved(t):
        c = step.contacts
        contacts = changed(c, phi=c.phi + t * phi, mu_v=c.mu_v + t * mu_v)
        data = {"tau_u": step.tau_u + t * tau_u, "K_q": step.K_q + t * np.diag(K)}
        return step.replace(contacts=contacts, **data)

    little = 1e-6
    ahead, behind = (moved(t) for t in (little, -little))
    dH, dg, dA, db = (
        (u - v) / (2 * little)
        for u, v in zip(standard_form(ahead), standard_form(behind), strict=True)
    )
    S = np.diag(found.lam / found.slack)
    right = dg - dH @ x + dA.T @ found.lam - A.T @ S @ (dA @ x - db)
    dx = np.linalg.solve(H + A.T @ S @ A, right)
    expected = rate(lambda t: barrier_step(moved(t), kappa).x, little)
    assert_within(dx, expected, 1e-6 * np.abs(expected).max())
