"""Parts of a program that nothing couples are solved one by one, with the bits of the whole."""

import numpy as np
import pytest
from scipy.linalg import block_diag

from quasistatic_ref.certify.degeneracy import form_degeneracy, step_degeneracy
from quasistatic_ref.certify.exact import exact_slack, form_optimum
from quasistatic_ref.lab.scenes.rigid import program_step
from quasistatic_ref.lab.study.problems.answers import exact_answer
from quasistatic_ref.step.standard_form import StandardForm
from tests.oracles.forms import exact_form_of

SIZES = (1, 3, 4)
"""Of the parts."""


def random_parts(rng):
    """A program of small integers, full of ties, whose parts are strewn over it; rows by part."""
    L, A = (block_diag(*[rng.integers(-2, 3, (k * n, n)) for n in SIZES]) for k in (1, 3))
    strewn, of = (rng.permutation(len(M)) for M in (L, A))
    H = (L @ L.T + np.eye(len(L)))[np.ix_(strewn, strewn)]
    form = StandardForm(H, 1.0 * rng.integers(-2, 3, len(H)), 1.0 * A[np.ix_(of, strewn)],
                        -1.0 * rng.integers(0, 3, len(A)))  # fmt: skip
    return form, np.repeat(range(len(SIZES)), 3 * np.array(SIZES))[of]


@pytest.mark.parametrize("seed", range(10))
def test_parts_that_nothing_couples_have_the_bits_of_the_whole(seed):
    """Whatever rows they start from."""
    rng = np.random.default_rng(seed)
    form, of = random_parts(rng)
    without_parts = exact_form_of(*form)
    whole = form_optimum(without_parts)
    slack = exact_slack(without_parts, whole.working_set)
    answer = exact_answer(form, rng.permutation(len(of))[:4].tolist())
    for name, of_whole in (("x", whole.delta_q), ("net", whole.net), ("slack", slack)):
        assert getattr(answer, name).tobytes() == of_whole.tobytes()
    unique, smooth, _ = form_degeneracy(without_parts, whole.working_set)
    facts = step_degeneracy(program_step(*form), whole.working_set)
    assert (facts.multipliers_unique, facts.differentiable) == (unique, smooth)


def test_a_part_without_a_solution_is_proof_that_the_whole_has_none():
    """Its first row, twice: a x >= 1 and -a x >= 1."""
    form, of = random_parts(np.random.default_rng(0))
    one, other = np.flatnonzero(of == 1)[:2]
    form.A[other] = -form.A[one]
    form.b[[one, other]] = 1.0
    y = exact_answer(form).farkas
    assert y == {one: "1", other: "1"}
