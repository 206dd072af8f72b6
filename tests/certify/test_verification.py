"""Each residual answers to a planted violation with exactly the planted size."""

from collections import Counter
from contextlib import suppress
from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    InputError,
    StandardForm,
    StepNotSolved,
    optimality_residuals,
    solve_step,
    verify,
)
from quasistatic_ref.solve.natural_step import NaturalStep
from tests.closeness import assert_relative, assert_within
from tests.helpers import planted_step, residuals_of, sphere_on_floor
from tests.made import actuated_step, free_step, no_contacts
from tests.oracles.random_steps import drawn
from tests.tolerances import ROUNDING


def test_the_user_s_own_rows_are_judged_with_the_others():
    step, delta_q, lam = planted_step(5)
    row = np.ones(7)
    step = step.replace(extra=Extra(("own",), [row], [float(row @ delta_q) + 0.25]))
    found = residuals_of(step, delta_q, np.append(lam, 0.0))
    assert_within(found.primal, 0.25)
    found = residuals_of(step, delta_q, np.append(lam, -0.5))
    assert_within(found.dual, 0.5)
    assert_within(found.complementarity, 0.125)
    assert_within(found.stationarity, 0.5)


@pytest.mark.parametrize(
    ("mu_omega", "tau_n", "excess"),
    [
        (0.02, 0.0, 3.0),  # ||(3, 4, 0)|| - 2
        (0.02, 0.02 * 12, 11.0),  # ||(3, 4, 12)|| - 2
        (0.0, 0.0, 3.0),
        (0.0, 7.0, 7.0),  # a torque without a coefficient is itself the excess
    ],
)
def test_impulses_outside_an_ellipsoid_are_its_dual_residual(mu_omega, tau_n, excess):
    """f_n = 2 and tangential impulses of (3, 4) mu_v, in the order (n, d1, d2, spin)."""
    step = sphere_on_floor(mu_v=0.5, mu_omega=mu_omega).replace(cone="ellipsoid")
    lam = np.array([2.0, 0.5 * 3, 0.5 * 4, tau_n])
    found = residuals_of(step, np.zeros(6), lam)
    assert_relative(found.dual, excess)
    assert found.primal == 0.0
    inside = residuals_of(step, np.zeros(6), np.array([2.0, 0.5, 0.5, 0.0]))
    assert inside.dual == 0.0


def test_rows_of_the_user_beside_an_ellipsoid_are_judged_one_by_one():
    """At rest with x >= 0.3 and y >= 0.1; multipliers of -0.7 and -0.2."""
    step = sphere_on_floor().replace(
        cone="ellipsoid", extra=Extra(("x", "y"), np.eye(6)[:2], [0.3, 0.1])
    )
    found = residuals_of(step, np.zeros(6), np.array([0, 0, 0, 0, -0.7, -0.2]))
    assert_within(found.primal, 0.3)
    assert_within(found.dual, 0.7)
    assert_within(found.complementarity, 0.3 * 0.7)


def test_the_work_of_a_contact_in_an_ellipsoid_is_one_sum():
    """It rises and slips by 1 mm each; 2 N s along the normal and -2 N s along the slip: none."""
    step = sphere_on_floor().replace(cone="ellipsoid")
    delta_q = np.array([1e-3, 0.0, 1e-3, 0.0, 0.0, 0.0])
    found = residuals_of(step, delta_q, np.array([2.0, -2.0, 0.0, 0.0]))
    assert_within(found.complementarity, 0.0)
    pressed = residuals_of(step, delta_q, np.array([2.0, 0.0, 0.0, 0.0]))
    assert_within(pressed.complementarity, 2e-3)


@pytest.mark.parametrize("turned", [0.0, 0.3])
@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
def test_residuals_of_what_is_at_rest_are_measured_by_its_loads(cone, turned):
    """Springs hold a weight up to rounding: g is noise, of which the exact answer has another."""
    turn = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
    K_q = turn @ np.diag([200.0, 90.0]) @ turn.T
    stretched = np.array([0.1, 0.3])
    at_rest = actuated_step(K_q, -(K_q @ stretched), stretched, no_contacts(2), 0.01)
    step = at_rest.replace(cone=cone)
    for certify in ("full", "residual"):
        residuals = solve_step(step, certify=certify).certificate.residuals
        assert max(residuals.values()) < ROUNDING


def test_residuals_of_a_subnormal_answer_are_of_the_answer_as_given():
    """A mass of 3 kg in a second: x* = tau / 3, of which delta_q has no digit."""
    tau = 1e-323
    step = free_step(np.array([[3.0]]), np.array([tau]), no_contacts(1), 1.0)
    solution = solve_step(step, "daqp", certify="residual")
    off = abs(3 * Fraction(solution.delta_q[0]) - Fraction(tau))
    units = NaturalStep(step).units
    natural = off * Fraction(units.coordinate[0]) / Fraction(units.size)
    assert solution.certificate.residuals["stationarity"] == natural > 0


@pytest.mark.shared
@pytest.mark.parametrize("backend", ["none", "daqp", None])
def test_an_answer_near_the_ends_of_float64_is_verified_or_refused_in_a_sentence(backend):
    kinds = Counter()
    for seed in range(60):
        with suppress(InputError):
            step = drawn(seed, "any wide")
            try:
                solution = solve_step(step, backend)
            except StepNotSolved as failure:
                kinds[type(failure).__name__] += 1
                continue
            assert verify(solution), seed
            kinds["verified"] += 1
    assert kinds["verified"] > 20


def test_residuals_of_large_multipliers_are_numbers():
    """Two rows oppose each other: 2^332 2^770 is beyond float64, their difference is zero."""
    A = 2.0**332 * np.array([[1.0, 0.0], [-1.0, 0.0]])
    form = StandardForm(np.eye(2), np.zeros(2), A, np.zeros(2))
    most = 2.0**770
    assert optimality_residuals(form, [0.0, 0.0], [most, most]).worst == 0.0
    off = optimality_residuals(form, [0.0, 0.0], [most, most / 2])
    assert (off.stationarity, off.primal) == (np.inf, 0.0)
