"""The error bound in float64, on steps so small that the exact optimum is known."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import block_diag
from scipy.sparse import csc_matrix

from quasistatic_ref import Extra, StepNotSolved, load_scenario, solve_step
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.optional.large import float_bound
from quasistatic_ref.optional.large.bound import error_bound
from quasistatic_ref.optional.large.float_bound import FloatBound, least_way
from quasistatic_ref.optional.large.judged import bound_verdict
from quasistatic_ref.optional.large.least_eigenvalues import least_eigenvalues
from quasistatic_ref.optional.large.opening import opening
from quasistatic_ref.solve.units import StepInBothUnits, Units, natural_step
from tests.helpers import point_on_floor, random_step
from tests.optional.large.test_bound import made_up, within
from tests.oracles.random_steps import any_step

FUZZED = 60
"""Random steps with answers made to look good."""

RIGHT_OR_WRONG = {"least": -17, "balanced": 0.3, "factors": (1.0, 1.0, 0.5, 2.0, -1.0)}


def bound_of(step, delta_q, lam):
    """The bound of an answer in SI units; infinite where none is known."""
    both = StepInBothUnits(step)
    return FloatBound(both.hessian.natural_H).step_error(both, delta_q, lam)


@pytest.mark.parametrize("bound_by", [error_bound, bound_of])
def test_no_answer_of_random_badly_scaled_steps_has_a_false_bound(bound_by):
    rng = np.random.default_rng(5)
    bounded = 0
    for _ in range(FUZZED):
        sizes = (int(v) for v in rng.integers((0, 1, 1), (3, 5, 4)))
        step = any_step(rng, *sizes, mass_ratio=rng.choice([1.0, 1e4, 1e9]))
        cone = rng.choice(["pyramid", "product", "facets-6", "frictionless"])
        step = step.replace(cone=str(cone))
        if rng.random() < 0.5:
            units = 2.0 ** rng.integers(-20, 21, step.n_v), 2.0 ** int(rng.integers(-20, 21)), 1.0
            step = natural_step(step, Units(*units))
        try:
            exact = step_optimum(step)
        except StepNotSolved:
            continue
        for _ in range(3):
            answer = made_up(rng, step, exact, **RIGHT_OR_WRONG)
            bound = bound_by(step, *answer)
            assert within(step, exact, answer[0], bound, answer[1])
            bounded += bound < 1
    assert bounded > FUZZED


def test_rows_of_the_user_s_own_are_bounded():
    """A point on a floor is pulled against a wall, x <= 1e-3 m, and told to be a little beyond."""
    wall = Extra(("wall",), -np.eye(3)[:1], [-1e-3])
    step = point_on_floor(force=(400.0, 0.0, -3.0)).replace(extra=wall)
    exact = step_optimum(step)
    beyond = exact.delta_q + np.array([1e-12, 0.0, 0.0])
    bound = bound_of(step, beyond, exact.lam)
    assert 1e-12 / np.abs(exact.delta_q).max() < bound < 1e-6
    assert within(step, exact, beyond, bound, exact.lam)


def test_a_bound_that_is_too_large_is_tried_in_balls(monkeypatch):
    step = grasp_step(np.random.default_rng(4))
    quick = solve_step(step, "daqp", certify="residual", fast=True)
    monkeypatch.setattr("quasistatic_ref.optional.fast.solver.BOUNDED", 0.0)
    slow = solve_step(step, "daqp", certify="residual", fast=True)
    assert slow.certificate.error_bound == error_bound(step, slow.delta_q, slow.lam)
    assert quick.certificate.error_bound < 1e-6


@pytest.mark.extra("fast")
def test_a_direction_is_kept_while_it_opens_the_rows_that_are_violated(monkeypatch):
    """Of a block on a slope; what a file would say of its steps is compared in fractions."""
    sought = []
    found = float_bound.opening
    monkeypatch.setattr(float_bound, "opening", lambda *of: sought.append(of) or found(*of))
    scenario = load_scenario("block_incline", ["solver.certify=residual"], fast=True)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    for _ in range(20):
        result = simulator.step(q, np.zeros(0))
        q = result.q
        answer = result.solution
        bound = answer.certificate.error_bound
        assert bound < 1e-6
        assert bound_verdict(result.step, answer.delta_q, answer.lam.ravel(), bound)
    assert 1 <= len(sought) <= 5


def test_what_is_wedged_broken_or_too_large_has_no_bound():
    A = csc_matrix(np.array([[1.0, 0.0], [-1.0, 0.0]]))
    assert opening(A, np.zeros(2)) is None
    assert opening(A, np.array([0.0, 1e3])) is not None  # the other wall is far away
    assert opening(csc_matrix(np.zeros((1, 2))), np.zeros(1)) is None
    step = random_step(np.random.default_rng(1))
    exact = step_optimum(step)
    for bad in (np.nan, np.inf, 2.0**120):
        assert bound_of(step, exact.delta_q + bad, exact.lam) == np.inf
        assert bound_of(step, exact.delta_q, exact.lam + bad) == np.inf


def test_the_way_is_long_enough_for_its_own_rounding():
    rng = np.random.default_rng(3)
    for _ in range(300):
        low = -(10.0 ** rng.uniform(-16, -8, 5))
        opens = rng.random(5) + 0.5
        t = least_way(low, opens)
        assert t < np.inf
        exactly = [Fraction(a) + Fraction(t) * Fraction(b) for a, b in zip(low, opens, strict=True)]
        assert min(exactly) >= 0
    assert least_way(np.array([-1.0, 1.0]), np.array([1.0, -2.0])) == np.inf
    assert least_way(np.array([-1.0]), np.array([0.0])) == np.inf


def test_eigenvalues_of_blocks_are_bounded_from_below_and_never_above_the_true_ones():
    """Of [[1, c], [c, 1]] the smallest is 1 - c; the coordinates of a block stand anywhere."""
    cosines = 1.0 - np.array([0.5, 1e-3, 1e-9, 2.0**-50])
    blocks = [np.array([[1.0, c], [c, 1.0]]) for c in cosines]
    blocks += [np.array([[1e-3]]), np.array([[5.0]])]
    smallest = np.array([*np.repeat(1 - cosines, 2), 1e-3, 5.0])
    order = np.random.default_rng(4).permutation(len(smallest))
    H = block_diag(*blocks)[np.ix_(order, order)]
    least = least_eigenvalues(csc_matrix(H))
    assert (least <= smallest[order]).all()
    assert (least >= 0.4 * smallest[order] - 1e-14).all()
    assert (least_eigenvalues(csc_matrix(np.array([[1.0, 2.0], [2.0, 1.0]]))) <= 0).all()
