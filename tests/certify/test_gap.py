"""The duality gap and the energies it is compared with, against plain fractions."""

import math
from fractions import Fraction

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref.certify.gap import (
    duality_gap,
    energy,
    fractions,
    free_energy,
)
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.optional.ellipsoid.gap import in_joules, negligible
from quasistatic_ref.tolerances import IMPULSES
from tests.certify.test_rational import fraction
from tests.oracles.random_steps import any_step
from tests.oracles.rational_kkt import exact, solved
from tests.oracles.solution_truth import program


def steps():
    rng = np.random.default_rng(5)
    return [any_step(rng, 2, 3, 3), any_step(rng, 0, 4, 2, 1e4), grasp_step(rng)]


@pytest.mark.parametrize("step", steps())
def test_gap_and_energies_are_those_of_their_formulas(step, rng):
    form = exact_form(step)
    delta_q = rng.normal(size=step.n_v)
    lam = rng.random(form.m)
    x = fractions(delta_q, form.x_unit)
    # lam's unit: that of an impulse over that of a row; f(x) - d(lam) =
    # 1/2 ||H x - g - A' lam||^2 in the norm of H^-1, plus lam'(A x - b).
    H, g, A, b = program(step)
    X = exact(delta_q)
    Y = exact(lam)
    off = H @ X - g - Y @ A
    unit = fraction(form.net_unit) * fraction(form.x_unit)
    expected = off @ solved(H, off) / 2 + Y @ (A @ X - b)
    found = duality_gap(form, x, fractions(lam, form.lam_unit))
    assert fraction(found) * unit == expected
    free = g @ solved(H, g) / 2
    taken = X @ H @ X / 2
    assert fraction(free_energy(form)) * unit == free
    assert fraction(energy(form, x)) * unit == taken
    joules = in_joules(form, found)
    assert Fraction(joules) >= expected > Fraction(math.nextafter(joules, -math.inf))
    limit = Fraction(IMPULSES) * (free + taken) / unit
    at = fmpq(limit.numerator, limit.denominator)
    assert negligible(form, x, at)
    assert not negligible(form, x, at * (1 + fmpq(1, 10**30)))


@pytest.mark.parametrize("value", [0.0, 1.0, -1.0, 0.1, 5e-324])
def test_a_gap_in_joules_is_never_below_what_it_is(value):
    form = exact_form(grasp_step(np.random.default_rng(0)))
    unit = form.net_unit * form.x_unit
    (exact,) = fractions(np.array([value]), unit)
    assert in_joules(form, exact) == value
    assert in_joules(form, exact + fmpq(1, 10**400) / unit) == math.nextafter(value, math.inf)
    assert in_joules(form, exact - fmpq(1, 10**400) / unit) == value
