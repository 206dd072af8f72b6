"""The parameterised CVXPY problem: its size, its cache, its empty cases, its multipliers."""

import cvxpy as cp
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from quasistatic_ref import StepDataError, StepProblem, solve_step
from quasistatic_ref.solve.through_cvxpy import CvxpySolver
from quasistatic_ref.step.friction import friction_rows
from quasistatic_ref.step.problem import paper_problem, set_values
from tests.closeness import assert_within
from tests.helpers import (
    PAPER,
    changed,
    error,
    planted_step,
    random_step,
)
from tests.tolerances import OPTIMUM


def with_mu_of(other, step):
    """The step with another's mu_v and mu_omega, which are constants of a compiled problem."""
    mu = {name: getattr(other.contacts, name) for name in ("mu_v", "mu_omega")}
    return step.replace(contacts=changed(step.contacts, **mu))


def test_nothing_is_compiled_after_the_first_solve(monkeypatch):
    first, *others = (planted_step(seed, *PAPER)[0] for seed in range(3))
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


@pytest.mark.parametrize(("n_a", "n_u"), [(3, 4), (0, 1), (1, 0)])
def test_the_page_splits_J_to_the_bits_of_the_rows(n_a, n_u, rng):
    """J_n, J_1, J_2 and J_w combined as in Eqs. (5)-(7) are friction_rows."""
    step = random_step(rng, n_a, n_u)
    page = paper_problem(step)
    set_values(page, step)
    filled = StepProblem(step).parameters
    for name, parameter in page.parameters.items():
        assert_array_equal(parameter.value, filled[name].value, strict=True)
    J_n, J_1, J_2, J_w = (page.parameters[name].value for name in ("J_n", "J_1", "J_2", "J_w"))
    mu_v, _, mu_omega = step.contacts.mu.T[..., None]
    parts = (mu_v * J_1, mu_v * J_2, -mu_v * J_1, -mu_v * J_2, mu_omega * J_w, -mu_omega * J_w)
    rows = np.stack([J_n + part for part in parts], axis=1)
    assert_array_equal(friction_rows(step.contacts), rows)


def test_a_step_of_another_kind_is_refused(rng):
    with pytest.raises(StepDataError, match=r"^h: must be 0\.01; make a problem of this step"):
        StepProblem(random_step(rng)).fill(random_step(rng).replace(h=0.02))
