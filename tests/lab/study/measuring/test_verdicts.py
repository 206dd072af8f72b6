"""Verdicts: residuals against promises, on toys and on the committed rows."""

import math

import numpy as np
import pytest

from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Setting, Solver
from quasistatic_ref.lab.study.measuring.false_claims import FACTOR, certificate_holds
from quasistatic_ref.lab.study.measuring.grade import grades, problem_forms
from quasistatic_ref.lab.study.measuring.judged_again import judged_again
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.store.store import Contents
from quasistatic_ref.solve.reply import Reply

MINE = Solver("mine", "callable", "m:f")
TIGHT = Setting("tight", 1e-9)


def dual_gradient(form, accuracy, sweeps=4000):
    """Projected ascent of the dual, one row after the other, until all residuals are small."""
    x = np.linalg.solve(form.H, form.g)
    W = np.linalg.solve(form.H, form.A.T)
    lam = np.zeros(len(form.b))
    size = np.einsum("ij,ji->i", form.A, W)
    for _ in range(sweeps):
        for i in np.flatnonzero(size):
            step = max((form.b[i] - form.A[i] @ x) / size[i], -lam[i])
            lam[i] += step
            x = x + step * W[:, i]
        slack = form.A @ x - form.b
        if -slack.min() <= accuracy and abs(lam @ slack) <= accuracy:
            return x, lam
    raise AssertionError("did not converge")


def row_of(problem, x, lam, units="natural", solver=MINE, setting=TIGHT):
    return grades(problem_forms(problem), units, Reply(x, lam, True, "returned"), solver, setting)


@pytest.fixture(scope="module")
def wedge():
    (found,) = set_read(problem_set_folder(CONTACT_QP), ids=["capped_wedge/1e-08/79"])
    return found


def test_an_answer_without_a_digit_that_keeps_its_tolerances_is_no_false_claim(wedge):
    """|lam*|_1 = 4.9e8: residuals below 1e-6 leave an error of 0.37 of the whole step."""
    x, lam = dual_gradient(wedge.natural.form, 1e-6)
    row = row_of(wedge, x, lam, setting=Setting("mine", 1e-6))
    assert max(row["residuals"].values()) <= 1e-6
    assert row["digits"]["delta_q"] < 0.5
    assert (row["wrong"], row["wrong_multipliers"]) == (False, False)


@pytest.mark.parametrize("units", ["raw", "natural"])
def test_a_residual_beyond_the_factor_is_a_false_claim_by_its_kind(problem, units):
    """The displacement is moved along H^-1 A_i': row i by t; each multiplier by t."""
    own = problem if units == "raw" else problem.natural
    form, answer = own.form, own.answer
    exact = row_of(problem, answer.x, answer.lam, units)
    assert (exact["wrong"], exact["wrong_multipliers"]) == (False, False)
    allowed = exact["allowed"]
    assert allowed["primal"] >= FACTOR * TIGHT.accuracy
    tight = int(np.argmax(answer.lam))
    for share, false in ((0.5, False), (2.0, True)):
        along = np.linalg.lstsq(form.A[[tight]], [-share * allowed["primal"]], rcond=None)[0]
        moved = row_of(problem, answer.x + along, answer.lam, units)
        primal = moved["residuals"]["primal"] > allowed["primal"]
        assert primal == false
        assert moved["wrong"] >= false
        lam = answer.lam.copy()
        lam[tight] = -share * allowed["dual"]
        zeros = row_of(problem, answer.x, lam, units)
        assert zeros["wrong"]
        assert zeros["wrong_multipliers"]


def test_right_x_and_zero_multipliers_is_a_false_claim_and_is_a_negative_multiplier(problem):
    own = problem.natural
    row = row_of(problem, own.answer.x, np.zeros(len(own.form.b)))
    assert row["digits"]["delta_q"] == 16.0
    assert (row["wrong"], row["wrong_multipliers"]) == (True, True)
    lam = own.answer.lam.copy()
    idle = int(np.argmin(abs(own.form.A).sum(axis=1)))
    lam[idle] -= 1e-3
    less = row_of(problem, own.answer.x, lam)
    assert less["residuals"]["dual"] >= 1e-3 - own.answer.lam[idle]
    H, g, A, _ = own.form  # A'lam is off by 1e-3 A_i', which moves by H^-1 A_i'
    off = 1e-3 * np.sqrt(A[idle] @ np.linalg.solve(H, A[idle]) / (g @ np.linalg.solve(H, g)))
    assert less["digits"]["multipliers"] == pytest.approx(-np.log10(off), abs=1e-6)


def test_proxqp_whose_documentation_states_no_limit_of_signs_is_held_to_a_thousandth(problem):
    """A row with b = 0, which leaves the gap as it is; both break OSQP's promise."""
    own = problem.natural
    idle = np.flatnonzero((own.form.b == 0) & (own.answer.lam == 0))[0]
    high = next(one for one in SETTINGS if one.name == "high")
    for negative, false in ((1e-5, False), (1.0, True)):
        lam = own.answer.lam.copy()
        lam[idle] = -negative
        for name, wrong in (("proxqp", false), ("osqp", True)):
            solver = Solver(name, "native", name)
            row = row_of(problem, own.answer.x, lam, solver=solver, setting=high)
            assert (row["wrong"], row["wrong_multipliers"]) == (wrong, wrong)


def test_success_without_a_solution_is_false_beyond_the_tolerances_alone():
    (none,) = set_read(problem_set_folder(CONTACT_QP), ids=["infeasible/1.14868e-11/243"])
    form = none.natural.form
    near = dual_gradient(form, 1e-3)
    kept = row_of(none, *near, setting=Setting("loose", 1e-3))
    assert (kept["said_optimal"], kept["wrong"]) == (True, False)
    zeros = np.zeros(len(form.g)), np.zeros(len(form.b))
    assert row_of(none, *zeros, setting=TIGHT)["wrong"]


def test_relative_tolerances_without_a_solution_are_those_of_the_answer():
    """As a solver measures them: FACTOR 1e-3 |Ax|, to which the terms' rounding adds 1e-12."""
    (none,) = set_read(problem_set_folder(CONTACT_QP), ids=["infeasible/0.01/0"])
    form = none.natural.form
    relative = {"tight": {"primal": {"rel": 1e-3, "of": ["|Ax|"]}}}
    solver = Solver("mine", "callable", "m:f", promised=relative)
    for size in (1.0, 1e4):
        x = np.full(len(form.g), size)
        row = row_of(none, x, np.zeros(len(form.b)), solver=solver)
        limit = FACTOR * 1e-3 * abs(form.A @ x).max()
        assert row["allowed"]["primal"] == float(f"{limit:.3g}")


def test_a_certificate_clears_a_claim_only_where_it_holds_to_the_accuracy(wedge, problem):
    """Scaled to 1, the multipliers of the wedge have |A'y| = 2e-9 and b'y > 0: a near proof."""
    form = wedge.natural.form
    y = wedge.natural.answer.lam / wedge.natural.answer.lam.max()
    size = abs(form.A.T @ y).max()
    assert form.b @ y > 0
    assert certificate_holds(form, y, size)
    assert not certificate_holds(form, y, size / (2 * FACTOR))
    assert not certificate_holds(form, -y, size)
    for accuracy, false in ((1e-6, False), (1e-12, True)):
        said = Reply(None, y, False, "infeasible")
        row = grades(problem_forms(wedge), "natural", said, MINE, Setting("mine", accuracy))
        assert (row["said_infeasible"], row["wrong"]) == (True, false)


# -- The committed rows ----------------------------------------------------------------------------


def test_no_row_called_false_has_all_of_its_residuals_within_the_limits(committed):
    false = [row for row in committed.rows if row["wrong"] and row["said_optimal"]]
    assert len(false) > 200
    for row in false:
        pairs = [(row["residuals"][name], most) for name, most in row["allowed"].items()]
        assert any(most is not None and value > most for value, most in pairs), row


def test_no_row_called_true_exceeds_a_limit(committed):
    for row in committed.rows:
        if row["said_optimal"] and not row["wrong"]:
            for name, most in row["allowed"].items():
                assert most is None or row["residuals"][name] <= most


def test_the_verdicts_of_the_committed_rows_are_those_of_the_files_of_options(committed):
    """Of every twentieth row, and of all that are false."""
    rows = [r for k, r in enumerate(committed.rows) if k % 20 == 0 or r["wrong"]]
    ids = sorted({row["problem"] for row in rows})
    part = Contents(committed.study, rows, committed.problems, {})
    again = judged_again(part, set_read(problem_set_folder(CONTACT_QP), ids=ids))
    assert again.rows == rows
    assert again.study["solvers"] == committed.study["solvers"]


def test_every_committed_answer_obeys_the_bound_by_three_residuals(committed):
    """(R48) in digits; the dual residual is the larger of balance and negative multipliers.

    ||x - x*||_H^2 <= gap + |lam*|_1 primal + (|x*|_1 + |s*|_1) dual.
    """
    ids = sorted({row["problem"] for row in committed.rows if row["feasible"]})
    sizes = {}
    for problem in set_read(problem_set_folder(CONTACT_QP), ids=ids):
        own = problem.natural.answer
        numbers = (own.lam, np.concatenate([own.x, own.slack]))
        sizes[problem.id] = [problem_forms(problem).length, *(abs(v).sum() for v in numbers)]
    count = 0
    for row in committed.rows[::20]:
        size = sizes.get(row["problem"])
        if row["outcome"] != "solved" or not size or row["units"] != "natural" or not size[0]:
            continue
        length, lam, others = size
        primal, dual, gap = (1.005 * v for v in row["residuals"].values())  # three figures
        error = math.sqrt(gap + lam * primal + others * dual) / length
        if error > 1e-12:  # of float64, whose rounding is in the residuals
            count += 1
            assert row["digits"]["delta_q"] >= min(-math.log10(error), 16) - 0.01, row
    assert count > 1000
