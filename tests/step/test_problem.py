"""The parameterised CVXPY problem: its size, its cache, its empty cases, its multipliers."""

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import Extra, StepDataError, StepProblem, solve_step
from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.solve.through_cvxpy import CvxpySolver
from tests.closeness import assert_relative, assert_within
from tests.helpers import (
    JUDGE,
    changed,
    error,
    planted_step,
    random_step,
)
from tests.tolerances import MULTIPLIERS, OPTIMUM

PAPER = {"n_a": 7, "n_u": 6, "rows": (6,) * 10 + (4,) * 5}


def filled_problem(step):
    problem = CvxpyProblem(step)
    problem.fill(step)
    return problem


def with_mu_of(other, step):
    """The step with another's mu_v and mu_omega, which are constants of a compiled problem."""
    mu = {name: getattr(other.contacts, name) for name in ("mu_v", "mu_omega")}
    return step.replace(contacts=changed(step.contacts, **mu))


def test_the_paper_s_step_compiles_to_13_variables_and_80_rows(rng):
    problem = filled_problem(random_step(rng, **PAPER)).problem
    data, _, _ = problem.get_problem_data(cp.OSQP, solver_opts={})
    assert data["P"].shape == (13, 13)
    assert data["F"].shape == (80, 13)


def test_nothing_is_compiled_after_the_first_solve(monkeypatch):
    first, *others = (planted_step(np.random.default_rng(seed), **PAPER)[0] for seed in range(3))
    others = [with_mu_of(first, step) for step in others]
    kept = CvxpySolver(first, "clarabel")
    solve_step(first, kept)
    compiled = kept.problem.problem._cache.param_prog
    assert compiled is not None

    def recompile(*_, **__):
        raise AssertionError("CVXPY compiled the problem again")

    monkeypatch.setattr(cp.Problem, "_construct_chain", recompile)
    for step in others:
        answer = solve_step(step, kept, certify="off").delta_q
        truth = solve_step(step, "none").delta_q
        assert_within(error(step, answer, truth), 0.0, OPTIMUM)
        assert kept.problem.problem._cache.param_prog is compiled


@pytest.mark.parametrize(("n_a", "n_u", "rows"), [(0, 4, (6, 4)), (3, 0, (4, 6))])
def test_empty_blocks_are_left_out(n_a, n_u, rows, rng):
    step, delta_q, lam = planted_step(rng, n_a, n_u, rows)
    answer = solve_step(step, JUDGE, certify="off")
    assert_within(error(step, answer.delta_q, delta_q), 0.0, OPTIMUM)
    assert answer.lam.shape == lam.shape


def test_a_row_of_the_user_s_own_holds_a_coordinate_back(rng):
    # Alone, delta_q_a would be tau_a / K; the row -delta_q_a >= -limit stops it there with the
    # multiplier h (tau_a - K limit).
    step = random_step(rng, 1, 1, rows=()).replace(
        K_q=[[100.0]],
        tau_a=[2.0],
        delta_q_bar_a=[0.0],
        extra=Extra(("stop",), [[-1.0, 0.0]], [-0.005]),
    )
    answer = solve_step(step, JUDGE, certify="off")
    push = step.h * (2.0 - 100.0 * 0.005)
    assert_relative(answer.delta_q[0], 0.005, OPTIMUM)
    assert_relative(answer.lam_extra, [push], MULTIPLIERS)


def test_multipliers_are_contact_major_though_cvxpy_s_are_not(rng):
    step, _, lam = planted_step(rng, 3, 4, rows=(4, 6, 4, 6))
    answer = solve_step(step, JUDGE)
    assert_within(answer.lam, lam, MULTIPLIERS * lam.max())


@pytest.mark.parametrize("name", ["product", "facets-8", "frictionless", "ellipsoid"])
def test_the_paper_s_rows_are_not_taken_for_those_of_another_cone(name, rng):
    with pytest.raises(StepDataError, match=r"cone: is not the pyramid; CvxpyProblem"):
        StepProblem(random_step(rng).replace(cone=name))


def test_rows_of_a_user_s_own_are_not_dropped(rng):
    step = random_step(rng).replace(extra=Extra(("a",), np.ones((1, 7)), [0.0]))
    with pytest.raises(StepDataError, match="extra: has a user's own rows; CvxpyProblem"):
        StepProblem(step)
