"""The families of problems that have a dial, by formulas for what the dial does."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.study.problems.families.dials import DIALS, one_turned, turned
from quasistatic_ref.lab.study.problems.making import family_problems, problem_of
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.step.standard_form import standard_form

SHORT = [name for name in DIALS if name not in ("sparse", "ellipsoid", "near_copies", "condition")]


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
    rounded, true = exact_form_of(*standard_form(one.step)), exact_form(one.step)
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


@pytest.mark.parametrize("overlap", [1e-2, 1e-6, 1e-13])
def test_walls_that_overlap_leave_no_solution(overlap):
    """Rows a x >= -phi and -a x >= phi + overlap, whose sum is 0 >= overlap."""
    tight = problem_of(one_turned("infeasible", overlap, 0, 1))
    y = tight.answer.farkas
    assert isinstance(dual_active_set(exact_form_of(*tight.form)), Farkas)
    assert sum(float(Fraction(v)) * tight.b[i] for i, v in y.items()) > 0


@pytest.mark.parametrize("room", [1e-3, 1e-7, 1e-13])
def test_a_cage_with_room_allows_to_stand_still_and_one_without_nothing(room):
    """All gaps positive: x = 0 satisfies A x >= b; all negative, and normals all around: none."""
    roomy = problem_of(one_turned("narrow", room, 1, 1))
    assert (roomy.b < 0).all()
    assert not roomy.answer.farkas
    assert problem_of(one_turned("infeasible", room, 1, 1)).answer.farkas


def test_a_wedge_is_left_by_its_depth_over_its_angle():
    """Walls that reach 1e-4 m into a body, an angle of 1e-5 apart: it moves by about 10 m."""
    (one,) = family_problems("wedge", 1, 3)
    assert one.facts["dial"] == 1e-9
    found = problem_of(one_turned("wedge", 1e-5, 0, 3))
    assert 1.0 < np.abs(found.answer.x).max() < 1e3


def test_a_wall_of_bricks_is_bounded_and_has_few_entries():
    one = problem_of(one_turned("sparse", 20, 0, 2))
    assert one.facts["n"] == 120
    assert one.A.nnz < 13 * one.facts["m"]
    assert 0 < one.answer.error < 1e-6
