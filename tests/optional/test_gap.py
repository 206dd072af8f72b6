"""The duality gap and the energies it is compared with, against plain fractions."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from flint import arb, fmpq

from quasistatic_ref import solve_step
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.gap import negligible, rounded_up
from quasistatic_ref.optional.ellipsoid.tolerances import IMPULSES
from quasistatic_ref.optional.gap import (
    duality_gap,
    energy,
    fractions,
    free_energy,
    nearest_above,
)
from tests.oracles.random_steps import drawn
from tests.oracles.rational_kkt import exact, on_rows, solution
from tests.oracles.rational_kkt import fractions as in_python
from tests.oracles.solution_truth import gap, program

SEEDS = range(6)
"""Of mixed steps that have a solution."""


def steps():
    return [drawn(seed, of) for seed, of in enumerate(("any", "small", "grasp"))]


@pytest.mark.parametrize("step", steps())
def test_gap_and_energies_are_those_of_their_formulas(step, rng):
    form = StepProgram(step)
    delta_q = rng.normal(size=step.n_v)
    lam = rng.random(form.m)
    x = fractions(delta_q)
    H, g, _, _ = of = program(step)
    X = exact(delta_q)
    expected = gap(of, X, exact(lam))
    free = g @ solution(H, g) / 2
    taken = X @ H @ X / 2
    found = duality_gap(form, x, fractions(lam))
    assert in_python([found, free_energy(form), energy(form, x)]) == [expected, free, taken]
    joules = rounded_up(found)
    assert Fraction(joules) >= expected > Fraction(math.nextafter(joules, -math.inf))
    limit = Fraction(IMPULSES) * (free + taken)
    at = fmpq(limit.numerator, limit.denominator)
    assert negligible(form, x, at)
    assert not negligible(form, x, at * (1 + fmpq(1, 10**30)))


def optimum(step):
    """The exact optimum, and multipliers of all rows."""
    active = solve_step(step).certificate.active
    working = [step.offsets[contact] + row for contact, row in active]
    lam = exact(np.zeros(step.m))
    x, lam[working] = on_rows(program(step), working)
    return x, lam


@pytest.mark.parametrize("seed", SEEDS)
def test_r47_a_gap_bounds_the_error_of_any_displacement(seed):
    """(R47): ||x - x*||_H^2 <= 2 (gap(x, lam) + lam*'v), where v covers what x violates.

    The two sides are 2 gap(x*, lam) + 2 lam*'(A x - b + v) apart.
    """
    rng = np.random.default_rng(seed)
    step = drawn(seed)
    best = optimum(step)
    H, _, A, b = of = program(step)
    lam = exact(rng.random(len(b)) * (rng.random(len(b)) < 0.3) * step.h)
    near = best[0] + exact(10.0 ** rng.uniform(-9, -3) * rng.normal(size=step.n_v))
    pushed = replace(step, tau_a=rng.normal(size=step.n_a), tau_u=rng.normal(size=step.n_u))
    feasible = optimum(pushed)[0]  # other loads, the same rows
    for x in (near, feasible):
        v = np.maximum(b - A @ x, 0)
        assert x is near or not v.any()
        error = (x - best[0]) @ H @ (x - best[0])
        bound = 2 * (gap(of, x, lam) + best[1] @ v)
        assert error <= bound
        assert bound - error == 2 * (gap(of, best[0], lam) + best[1] @ (A @ x - b + v))


@pytest.mark.parametrize("seed", SEEDS)
def test_r48_three_residuals_bound_the_error_of_any_answer(seed):
    """(R48), of any x and lam, some of them negative.

    The first bound is above the squared error by (lam + w)'s* + lam*'(A x - b + v), and below the
    second, which has norms alone.
    """
    rng = np.random.default_rng(seed)
    step = drawn(seed)
    best, press = optimum(step)
    H, g, A, b = program(step)
    slack = A @ best - b
    for size in (1e-9, 1e-3):
        x = best + exact(size * rng.normal(size=step.n_v))
        lam = press + exact(size * step.h * rng.normal(size=len(b)))
        v, w = np.maximum(b - A @ x, 0), np.maximum(-lam, 0)
        r = H @ x - g - lam @ A
        gap = x @ H @ x - g @ x - b @ lam
        first = gap + press @ v - best @ r + w @ slack
        error = (x - best) @ H @ (x - best)
        assert first - error == (lam + w) @ slack + press @ (A @ x - b + v) >= 0
        sizes = ((press, v), (best, r), (slack, w))
        assert first <= abs(gap) + sum(
            abs(one).sum() * max(abs(other), default=0) for one, other in sizes
        )


def test_nearest_above_is_above():
    with working_precision(200):
        assert Fraction(nearest_above(arb(1) / 3)) > Fraction(1, 3)
        assert nearest_above(arb(0)) == 0.0
        assert nearest_above(arb.pos_inf()) == math.inf
