"""The error bound holds for every answer, good or bad, and says so when it knows nothing."""

import numpy as np
from flint import fmpq

from quasistatic_ref import Extra, standard_form
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.form import StepForm
from quasistatic_ref.certify.minimiser import fraction_solution
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.optional.gap import duality_gap, energy, fractions, free_energy
from quasistatic_ref.optional.large.bound import error_bound, opening_direction
from quasistatic_ref.tolerances import CLOSED_FORM
from tests.certify.test_farkas import EAST, point_between_walls
from tests.closeness import assert_relative


def test_bound_shows_about_eight_digits_of_an_exact_answer():
    rng = np.random.default_rng(8)
    for _ in range(10):
        step = grasp_step(rng)
        exact = step_optimum(step)
        assert 1e-10 < error_bound(step, exact.delta_q, exact.lam) < 1e-6


def test_step_without_contacts_is_bounded_to_rounding():
    step = point_between_walls(np.zeros((0, 3)), [], force=(1.0, 2.0, 3.0))
    exact = step_optimum(step)
    assert error_bound(step, exact.delta_q, exact.lam) < 1e-15
    # (1 + s) delta_q is off by s times the length that errors are relative to.
    s = 2.0**-10
    found = error_bound(step, (1 + s) * exact.delta_q, exact.lam)
    assert_relative(found, s, CLOSED_FORM)


def test_wedged_or_broken_answers_are_not_bounded():
    pair = Extra(("left", "right"), [[1.0, 0, 0], [-1.0, 0, 0]], np.zeros(2))
    step = point_between_walls([EAST], [1.0], force=(1.0, 0.0, 0.0)).replace(extra=pair)
    assert opening_direction(step) is None
    lam = np.zeros(6)
    assert error_bound(step, np.array([1e-9, 0, 0]), lam) == np.inf
    assert error_bound(step, np.array([np.nan, 0, 0]), lam) == np.inf
    assert error_bound(step, np.zeros(3), lam) < np.inf  # feasible as it stands
    rest = point_between_walls([EAST], [1.0])
    assert error_bound(rest, np.zeros(3), np.zeros(4)) == np.inf  # g = 0: no scale


def test_a_direction_is_found_in_a_narrow_wedge():
    eps = 1e-5  # half its angle [rad]
    sides = Extra(("left", "right"), [[1.0, eps, 0], [-1.0, eps, 0]], np.zeros(2))
    step = point_between_walls(np.zeros((0, 3)), [], force=(1.0, 0.0, 0.0)).replace(extra=sides)
    v = opening_direction(step)
    assert (sides.A @ v > 0).all()  # |v_x| < eps v_y
    # 1e-9 m along x is beyond the right side; along v it gets back.
    exact = step_optimum(step)
    assert error_bound(step, np.array([1e-9, 0.0, 0.0]), exact.lam) < np.inf


def made_up(rng, step, exact, least=-9, balanced=0.5, factors=(1.0, 0.5, 2.0, -1.0)):
    """An answer that is wrong in a way that a careless bound does not see, and its multipliers.

    It is wrong by 10^least and more; `balanced` is how often multipliers of any sign balance it.
    """
    form = standard_form(step)
    d = opening_direction(step)
    size = 10.0 ** rng.uniform(least, 1) * max(np.abs(exact.delta_q).max(), 1e-9)
    delta_q = exact.delta_q.copy()
    lam = exact.lam.copy()
    if d is not None and rng.random() < 0.5:
        delta_q += rng.choice([-1.0, 1.0]) * size * d / np.abs(d).max()
    else:
        delta_q += size * rng.standard_normal(len(delta_q))
    if rng.random() < balanced and len(lam):
        lam = np.linalg.lstsq(form.A.T, form.H @ delta_q - form.g, rcond=None)[0]
    return delta_q, lam * rng.choice(factors)


def within(step, exact, delta_q, bound, lam=None):
    """Whether an answer is as near to the optimum as a bound says, without rounding of either.

    With multipliers, whether the bound is true of these too: of their gap at the optimum.
    """
    if bound == np.inf:
        return True
    form = StepForm(step)
    best = fraction_solution(form, exact.working_set).point
    off = [a - b for a, b in zip(fractions(delta_q), best, strict=True)]
    gap = fmpq(0)
    if lam is not None:
        gap = duality_gap(form, best, fractions(np.maximum(lam, 0.0)))
    (most,) = fractions(np.array([bound]))
    return energy(form, off) + gap <= most * most * free_energy(form)
