"""Multipliers on working sets near a base, and what an exchange of rows decides in balls."""

import numpy as np
import pytest

from quasistatic_ref.certify.active_set import least_index, most_violated
from quasistatic_ref.certify.dependence import combination, independent_rows
from quasistatic_ref.certify.form import StepForm
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.certify.working_set import NearSets, ball_solution
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from tests.oracles.random_steps import any_step, mixed_step


@pytest.mark.parametrize("seed", range(12))
def test_rows_that_enter_and_leave_have_the_multipliers_of_a_solution_of_its_own(seed):
    rng = np.random.default_rng(seed)
    form = StepForm(any_step(rng, 3, 18, 12))
    order = independent_rows(form, rng.permutation(form.m).tolist())
    base = order[: rng.integers(0, len(order))]
    near = NearSets(form, base)
    exchanged = rng.integers(0, 3)
    working = tuple(rng.permutation(order[exchanged : len(base) + rng.integers(1, 3)]).tolist())
    own = ball_solution(form, working)
    updated = ball_solution(form, working, near)
    assert near.has_near(working)
    pairs = [*zip(own.y, updated.y, strict=True), *zip(own.x, updated.x, strict=True)]
    assert all(one.overlaps(other) and float(other.rad()) < 1e-60 for one, other in pairs)


@pytest.mark.parametrize("seed", range(12))
def test_a_relation_is_that_of_elimination(seed):
    """Also where balls show nothing: W is no set of independent rows to them."""
    form = StepForm(mixed_step(seed))
    rows = range(form.m)
    order = independent_rows(form, rows)
    working = order[: max(1, len(order) - seed % 3)]
    minimiser = Minimiser(form, working)
    for p in [i for i in rows if i not in working][:8]:
        relation = minimiser.relation(p)
        c = combination(form, working, p)
        assert (relation is None) == (c is None)
        if relation is not None:
            assert [relation.end(j) for j in range(len(working))] == [-c_j for c_j in c]


def test_a_row_that_balls_show_to_be_violated_enters_before_any_zero_is_decided():
    """x_0 >= 1 is held; 2 x_0 >= 2 follows from it, and (1 - 2^-53) x_0 >= 1 misses by 2^-53."""
    A = np.array([[1.0, 0.0], [2.0, 0.0], [1.0 - 2.0**-53, 0.0]])
    minimiser = Minimiser(exact_form_of(np.eye(2), np.zeros(2), A, np.array([1.0, 2.0, 1.0])), (0,))
    assert minimiser.open_rows == [1, 2]
    assert not minimiser.lowest_shown
    assert most_violated(minimiser) == least_index(minimiser) == 2
    fresh = minimiser.on((0,))
    assert most_violated(fresh) == 2
    assert "null_space" not in vars(fresh)
