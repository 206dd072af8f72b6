"""The rule for positive definite matrices, against exact pivots in fractions."""

import numpy as np
import pytest
from scipy.linalg import block_diag

from quasistatic_ref import Extra, StepData, StepDataError, solve_step
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.numbers.pivots import DEFINITE, MANY_ROWS, positive_pivots
from tests.closeness import assert_relative
from tests.made import actuated_step, no_contacts
from tests.oracles.random_steps import nearly_singular
from validation import check_solution as checker

LOWER = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [1.0, -1000.0, 1.0]])
PIVOTS = 3 * np.array([1.0, 2.0**-20, 2.0**-44])
NEAR = LOWER @ np.diag(PIVOTS) @ LOWER.T
"""No product or sum of these is rounded. The last pivot is 2.9e-14 of its diagonal entry; LAPACK's
Cholesky finds it negative."""


def positive_definite(S):
    """Whether the checker for sceptics, in fractions, takes a matrix."""
    return checker.definite(checker.fractions(S.tolist()))


def test_the_rule_is_that_of_exact_pivots():
    said = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        S = nearly_singular(rng, int(rng.integers(1, 6)))
        said.append(positive_pivots(S))
        assert said[-1] == positive_definite(S), S
    assert {True, False} == set(said)


@pytest.mark.parametrize("scale", [2.0**-1060, 2.0**-40, 1.0, 2.0**40, 2.0**900])
@pytest.mark.parametrize("factor", [0.25, 0.5, 1.0, 4.0])
def test_a_pivot_counts_from_its_share_on(factor, scale):
    """[[1, 1], [1, 1 + p]] has the pivots 1 and p: 2^-46 = 1.42e-14 is above 1e-14 (1 + p)."""
    p = factor * 2.0**-46 if scale > 2.0**-1000 else 2.0**-12
    S = scale * np.array([[1.0, 1.0], [1.0, 1.0 + p]])
    assert positive_pivots(S) == (p > DEFINITE * (1 + p))


def test_a_pivot_of_zero_is_none_also_where_rounding_makes_it_positive():
    """Unless something is taken off the diagonal first, float64 finds 3e-10 of its entry."""
    L = np.array([[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [1.0, -1757.0, 1.0]])
    S = 7 * L @ np.diag([1.0, 2.0**-21, 0.0]) @ L.T  # nothing is rounded
    assert not positive_pivots(S)


def test_a_stack_obeys_the_rule_if_each_of_its_matrices_does():
    assert positive_pivots(np.array([NEAR, np.eye(3)]))
    assert not positive_pivots(np.array([np.eye(3), -np.eye(3)]))


@pytest.mark.parametrize("last", [[[2.0]], [[-1.0]], [[0.0]]])
def test_blocks_of_a_large_matrix_obey_the_rule_one_by_one(last):
    S = block_diag(*[NEAR] * MANY_ROWS, last)
    assert positive_pivots(S) == (last[0][0] > 0)


def test_a_nearly_singular_stiffness_has_norms_and_an_exact_answer():
    """L (1, 0, 0) = (1, -1, 1) = g: x = (1/3, 0, 0), and ||H^-1 g|| = 3^-0.5."""
    for lost in (np.linalg.cholesky, np.linalg.inv):
        with pytest.raises(np.linalg.LinAlgError):
            lost(NEAR)
    norm = energy_norm(NEAR)
    assert_relative(norm.of_impulse(LOWER[:, 0]), 3**-0.5)
    assert_relative(norm.of_displacement(np.eye(3)[2]), NEAR[2, 2] ** 0.5)
    step = actuated_step(NEAR, LOWER[:, 0], np.zeros(3), no_contacts(3), 1.0)
    assert solve_step(step, "none").delta_q.tolist() == [1 / 3, 0.0, 0.0]


@pytest.mark.parametrize(("backend", "certify"), [("none", "full"), ("clarabel", "off")])
def test_a_hessian_that_rounding_makes_indefinite_is_refused_in_a_sentence(backend, certify):
    """K_q is, 0.07 K_q in float64 is not: the rounding of its products is larger than a pivot."""
    step = actuated_step(NEAR, np.ones(3), np.zeros(3), no_contacts(3), 0.07)
    assert not positive_definite(step.H)
    with pytest.raises(StepDataError, match=r"H: .*look for a link of almost no mass"):
        solve_step(step, backend, certify=certify)


@pytest.mark.parametrize(("sixteenths", "definite"), [(9, False), (10, True)])
@pytest.mark.parametrize("of", ["K_q", "M_u"])
def test_a_cost_is_added_without_rounding_also_where_numbers_are_subnormal(
    of, sixteenths, definite
):
    """With t = 2^-1074 the determinant of [[1 + e, 1], [1, e]] t is (e + e^2 - 1) t^2.

    That is -31/256 t^2 for e = 9/16, and 4/256 t^2 for e = 10/16; float64 rounds e t to t.
    """
    t = 2.0**-1074
    block = np.eye(2) * sixteenths / 16 * 2.0**-474
    a, u, h = (2, 0, 2.0**-600) if of == "K_q" else (0, 2, 2.0**600)
    zero = np.zeros
    step = StepData(h, block[:a, :a], block[:u, :u], zero(a), zero(u), zero(a), no_contacts(2))
    cost = Extra((), zero((0, 2)), [], H=[[t, t], [t, 0.0]])
    if definite:
        assert step.replace(extra=cost).extra == cost
    else:
        with pytest.raises(StepDataError, match="a cost must be convex"):
            step.replace(extra=cost)


def test_a_large_matrix_of_one_block_obeys_the_rule():
    assert positive_pivots(np.eye(3 * MANY_ROWS) + 0.5) is True


@pytest.mark.long
def test_a_large_dense_matrix_that_is_indefinite_is_not_taken():
    S = np.eye(MANY_ROWS + 1) + 1e-3
    assert positive_pivots(S)
    S[0, 1] = S[1, 0] = 2.0
    assert not positive_pivots(S)
