"""The families of problems that have a dial, by formulas for what the dial does."""

import numpy as np
import pytest

from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.study.problems.families.dials import DIALS, one_turned, turned
from quasistatic_ref.lab.study.problems.making import problem_of
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.step.standard_form import standard_form
from tests.oracles.rational_kkt import farkas_refutation

SHORT = [name for name in DIALS if name not in ("large", "near_copies", "condition")]


@pytest.mark.parametrize("family", DIALS)
def test_a_dial_goes_from_its_easy_end_to_its_hard_one_in_equal_ratios(family):
    dial = DIALS[family]
    values = dial.values(4)
    assert (values[0], values[-1]) == (dial.first, dial.most)
    ratios = np.array(values[1:]) / values[:-1]
    step = (dial.most / dial.first) ** (1 / 3)
    np.testing.assert_allclose(ratios, step, rtol=0.4 if dial.whole else 1e-5)
    assert dial.values(1, 3.0) == [3.0]


@pytest.mark.parametrize("family", SHORT)
def test_short_numbers_make_rows_that_are_not_rounded(family):
    """A of the float64 program is a multiple of that of the exact step, entry for entry."""
    one = one_turned(family, DIALS[family].values(3)[1], 0, 5)
    rounded = exact_form_of(*standard_form(one.step))
    true = exact_form(one.step)
    factor = true.slack_unit / true.x_unit, rounded.slack_unit / rounded.x_unit
    for i in range(true.m):
        exact = [a * factor[0] for a in true.row(i)]
        assert exact == [a * factor[1] for a in rounded.row(i)]


def test_the_condition_of_K_q_is_what_the_dial_says():
    for one in turned("condition", 4, 3, 1e6):
        unit = np.sqrt(np.diag(one.step.K_q))
        S = np.linalg.cond(one.step.K_q / np.outer(unit, unit))
        assert one.dial / 10 <= S <= 10 * one.dial


def test_copies_multiply_rows_and_leave_the_answer():
    """The rows of c copies are c times those of one contact; A x >= b stays the same set."""
    for one in turned("copies", 3, 3):
        form = standard_form(one.step)
        alone = one.step.contacts.n_c // round(one.dial)
        assert alone == 7
        m = len(form.b) // round(one.dial)
        np.testing.assert_array_equal(form.A[:m], form.A[-m:])


@pytest.mark.parametrize("clearance", [1e-3, 1e-7, 1e-13])
def test_a_cage_with_clearance_allows_to_stand_still(clearance):
    """All gaps positive: x = 0 satisfies A x >= b."""
    loose = problem_of(one_turned("narrow", clearance, 1, 1))
    assert (loose.b < 0).all()
    assert not loose.answer.farkas


@pytest.mark.parametrize("angle", [1e-1, 1e-5, 1e-9])
def test_a_wedge_is_left_by_millimetres_at_any_angle(angle):
    """Walls reach 1e-4 m times the angle into a body, which moves by about 1e-4 m or more."""
    found = problem_of(one_turned("capped_wedge", angle, 0, 2))
    assert 1e-4 < np.abs(found.answer.x).max() < 1e-1
    assert (found.b[-8:] == 1e-4 * angle).all()


@pytest.mark.parametrize("travel", [1e-2, 1e-6, 1e-13])
def test_joints_stay_within_their_limits(travel):
    """Rows e_i x >= -r and -e_i x >= -r', rooms between half and one and a half of the dial's."""
    one = problem_of(one_turned("limits", travel, 0, 2))
    n_a = 7
    assert (
        one.A.toarray()[-2 * n_a :] == np.concatenate([np.eye(n_a, 13), -np.eye(n_a, 13)])
    ).all()
    assert (np.abs(one.answer.x[:n_a]) <= 1.5 * travel).all()
    bearing = one.answer.lam[-2 * n_a :] > 0
    assert bearing.any() == (travel < 1e-2)


@pytest.mark.parametrize("overlap", [1e-2, 1e-6, 1e-13])
@pytest.mark.parametrize("family", [name for name in DIALS if not DIALS[name].solvable])
def test_what_overlaps_has_a_proof_that_there_is_no_solution(family, overlap):
    """Both scenes: walls and a cage, joints at their limits and a tower under a ceiling."""
    for i in range(2):
        one = problem_of(one_turned(family, overlap, i, 2))
        assert farkas_refutation(one.form.A, one.b, one.answer.farkas) is None


def test_a_wall_of_bricks_has_few_entries():
    """Two bodies of six coordinates in each row, at most, and blocks of 3 x 3 in H but for m I."""
    one = problem_of(one_turned("large", 8, 0, 2))
    assert one.facts["n"] == 48
    assert one.A.nnz <= 12 * one.facts["m"]
    assert one.H.nnz <= (3 + 9) * 8
