"""Verdicts: residuals against promises, on toys and on the committed rows."""

import numpy as np
import pytest

from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.false_claims import FACTOR, certificate_holds
from quasistatic_ref.lab.study.grade import grades, problem_forms
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.promises import RESIDUALS
from quasistatic_ref.lab.study.solvers import Setting, Solver
from quasistatic_ref.solve.reply import Reply

MINE = Solver("mine", "function", "m:f")
TIGHT = Setting("tight", 1e-9)


def dual_gradient(form, accuracy):
    """Projected ascent of the dual, one row after the other, until all residuals are small."""
    x = np.linalg.solve(form.H, form.g)
    W = np.linalg.solve(form.H, form.A.T)
    lam = np.zeros(len(form.b))
    size = np.einsum("ij,ji->i", form.A, W)
    for _ in range(4000):
        for i in np.flatnonzero(size):
            step = max((form.b[i] - form.A[i] @ x) / size[i], -lam[i])
            lam[i] += step
            x = x + step * W[:, i]
        slack = form.A @ x - form.b
        if -slack.min() <= accuracy and abs(lam @ slack) <= accuracy:
            return x, lam
    raise AssertionError("did not converge")


def row_of(problem, x, lam, units="natural", setting=TIGHT, claim="optimal"):
    promise = MINE.promise(setting, {})
    reply = Reply(x, lam, claim == "optimal", claim)
    return grades(problem_forms(problem), units, reply, MINE, promise, setting.accuracy)


@pytest.fixture(scope="module")
def wedge():
    (problem,) = set_read(problem_set_folder(CONTACT_QP), ids=["capped_wedge/1e-08/79"])
    return problem


def test_an_answer_without_a_digit_that_keeps_its_tolerances_is_no_false_claim(wedge):
    """|lam*|_1 = 4.9e8: residuals below 1e-6 leave an error of 0.37 of the whole step."""
    x, lam = dual_gradient(wedge.natural.form, 1e-6)
    row = row_of(wedge, x, lam, setting=Setting("mine", 1e-6))
    assert max(row[name] for name in RESIDUALS) <= 1e-6
    assert row["digits"] < 0.5
    assert not row["false_claim"]


@pytest.mark.parametrize("units", ["raw", "natural"])
def test_a_residual_beyond_the_factor_is_a_false_claim(problem, units):
    """The displacement is moved along H^-1 A_i': row i by t; each multiplier by t."""
    there = problem if units == "raw" else problem.natural
    form, answer = there.form, there.answer
    exact = row_of(problem, answer.x, answer.lam, units)
    assert not exact["false_claim"]
    assert exact["primal_limit"] >= FACTOR * TIGHT.accuracy
    tight = int(np.argmax(answer.lam))
    for share, false in ((0.5, False), (2.0, True)):
        shift = -share * exact["primal_limit"]
        along = np.linalg.lstsq(form.A[[tight]], [shift], rcond=None)[0]
        moved = row_of(problem, answer.x + along, answer.lam, units)
        assert (moved["primal"] > exact["primal_limit"]) == false
        assert moved["false_claim"] >= false
        lam = answer.lam.copy()
        lam[tight] = -share * exact["dual_limit"]
        assert row_of(problem, answer.x, lam, units)["false_claim"]


@pytest.mark.parametrize("name", ["gaps/1e-14/279", "infeasible/1.14868e-11/243"])
@pytest.mark.parametrize("size", [None, 1e308, 1e160])
def test_success_without_numbers_or_with_such_as_overflow_is_a_false_claim(name, size):
    (one,) = set_read(problem_set_folder(CONTACT_QP), ids=[name])
    n, m = one.natural.form.A.shape[::-1]
    x = None if size is None else np.full(n, size)
    for lam in (None, np.zeros(m)):
        row = row_of(one, x, lam)
        assert (row["claim"], row["false_claim"]) == ("optimal", True)
        assert all(row[name] is None or np.isfinite(row[name]) for name in RESIDUALS)


def test_success_without_a_solution_is_false_beyond_the_tolerances_alone():
    (none,) = set_read(problem_set_folder(CONTACT_QP), ids=["infeasible/1.14868e-11/243"])
    form = none.natural.form
    near = row_of(none, *dual_gradient(form, 1e-3), setting=Setting("loose", 1e-3))
    assert (near["claim"], near["false_claim"]) == ("optimal", False)
    assert row_of(none, np.zeros(len(form.g)), np.zeros(len(form.b)))["false_claim"]


def test_a_certificate_clears_a_claim_only_where_it_holds_to_the_accuracy(wedge):
    """Scaled to 1, the multipliers of the wedge have |A'y| = 2e-9 and b'y > 0: a near proof."""
    form = wedge.natural.form
    y = wedge.natural.answer.lam / wedge.natural.answer.lam.max()
    size = abs(form.A.T @ y).max()
    assert certificate_holds(form, y, size)
    assert not certificate_holds(form, y, size / (2 * FACTOR))
    for accuracy, false in ((1e-6, False), (1e-12, True)):
        row = row_of(wedge, None, y, setting=Setting("mine", accuracy), claim="infeasible")
        assert (row["claim"], row["false_claim"]) == ("infeasible", false)


# -- The committed rows ----------------------------------------------------------------------------


@pytest.mark.long
def test_a_committed_claim_of_success_is_false_where_a_residual_exceeds_its_limit(committed):
    """Or where its numbers are not finite."""
    false = 0
    for row in committed:
        if row.claim == "optimal":
            pairs = [(getattr(row, name), getattr(row, f"{name}_limit")) for name in RESIDUALS]
            exceeded = any(limit is not None and size > limit for size, limit in pairs)
            assert row.false_claim == (exceeded or row.outcome == "not a number"), row
            false += exceeded
    assert false > 200
