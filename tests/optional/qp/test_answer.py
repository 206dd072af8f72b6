"""Answers of quadratic programs in files: checked twice, forged ones refused."""

import json
import re

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.qp.files import load_answer
from tests.pages import ROOT
from validation import check_solution


def said(path, capsys):
    """The exit status of the checker in one file, and its last line."""
    status = check_solution.main(str(path))
    return status, capsys.readouterr().out.splitlines()[-1]


def test_the_program_of_the_page_prints_what_the_page_says(capsys):
    page = (ROOT / "docs" / "exact_qp.md").read_text("utf-8")
    code, printed = (
        re.search(rf"```{kind}\n(.*?)```", page, re.DOTALL)[1] for kind in ("python", "text")
    )
    exec(code, {})
    assert capsys.readouterr().out == printed


PROGRAM = {
    "P": [[2.0, 0.5], [0.5, 1.0]],
    "q": [-3.0, -1.0],
    "G": [[1.0, 1.0], [2.0, 2.0], [0.1, 3.0]],
    "h": [1.0, 2.0, 9.0],
    "A": [[1.0, -1.0]],
    "b": [0.3],
    "ub": [4.0, 4.0],
}
OPTIMUM = {
    "optimum": PROGRAM,
    "several": {"P": np.ones((2, 2)), "q": [-2.0, -2.0], "G": [[1.0, 0.0]], "h": [0.5],
                "lb": [-1.0, 0.0]},
}  # fmt: skip
NO_OPTIMUM = {
    "infeasible": ({"lb": [0.9, 0.2], "A": [[0.0, 0.0]], "b": [0.0], "ub": None}, qr.QPInfeasible),
    "crossed": ({"lb": [0.5, 3.0], "ub": [0.5, 2.0]}, qr.QPInfeasible),
    "unbounded": (
        {"P": np.diag([2.0, 0.0]), "q": [-3.0, 1.0], "A": None, "b": None, "ub": None},
        qr.QPUnbounded,
    ),
    "not convex": ({"P": np.diag([2.0, -3.0])}, qr.QPNotConvex),
}
FORGED = [
    # what is proved, what is said in its place, words of the reason
    ("optimum", {"x": [0.65, np.nextafter(0.35, 1)]}, ""),
    ("optimum", {"z": [0.0, 0.0, 1e-9]}, ""),
    ("optimum", {"y": [0.0]}, ""),
    ("optimum", {"z_box": [0.0, 1e-300]}, ""),
    ("optimum", {"obj": -1.0}, ""),
    ("optimum", {"obj_error": 0.0}, ""),
    ("optimum", {"active": ("A[0]",)}, ""),
    ("optimum", {"active": ("G[0]", "A[0]")}, ""),  # another order
    ("optimum", {"active": ("A[0]", "A[0]", "G[0]")}, ""),  # a row twice
    ("optimum", {"active": ("A[0]", "G[0]", "G[1]")}, ""),  # dependent rows
    ("optimum", {"active": ("A[0]", "G[2]")}, ""),  # of which one is not tight
    ("optimum", {"active": ("G[0]",)}, ""),  # without the equation
    ("optimum", {"active": ("A[0]", "G[7]")}, ""),  # no row
    ("optimum", {"multipliers_unique": True}, ""),
    ("optimum", {"q": [-6.0, -2.0]}, ""),
    ("infeasible", {"farkas": {"G[1]": "-1/2", "lb[0]": "1", "lb[1]": "1"}}, "of G[1] is negative"),
    ("infeasible", {"farkas": {"G[1]": "1", "lb[0]": "1", "lb[1]": "1"}}, "add up to zero"),
    ("infeasible", {"farkas": {"G[1]": "1/2", "ub[0]": "1", "lb[1]": "1"}}, "no limit"),
    ("infeasible", {"farkas": {"G[1]": "1e99"}}, "are no fractions"),
    ("infeasible", {"farkas": {}}, "are not negative"),
    ("infeasible", {"lb": [0.5, 0.2]}, "are not negative"),
    ("crossed", {"farkas": {"ub[1]": "1", "lb[1]": "2"}}, "add up to zero"),
    ("crossed", {"ub": [0.5, 4.0]}, "are not negative"),
    ("unbounded", {"x": ["2", "0"]}, "G[0] is violated by x"),
    ("unbounded", {"direction": ["0", "1"]}, "G[0] ends the direction"),
    ("unbounded", {"direction": ["-1", "-1"]}, "the cost grows along the direction"),
    ("unbounded", {"direction": ["0", "0"]}, "does not fall"),
    ("unbounded", {"q": [-3.0, 0.0]}, "does not fall"),
    ("unbounded", {"direction": ["0"]}, "no list of 2 fractions"),
    ("not convex", {"direction": ["1", "0"]}, "A[0] does not leave the direction"),
    ("not convex", {"direction": ["0", "0"]}, "does not cost less than nothing"),
    ("not convex", {"direction": ["1", "1", "1"]}, "no list of 2 fractions"),
    ("several", {"x": [0.25, 1.75]}, ""),  # another optimum
    ("several", {"least_norm": []}, ""),
    ("several", {"least_norm": ["G[0]", "G[0]"]}, ""),
    ("several", {"least_norm": ["G[4]"]}, ""),
    ("several", {"least_norm": ["lb[0]"]}, ""),  # a row that does not hold it
    ("several", {"active": ["G[0]"]}, ""),  # a row that bears nothing
    ("several", {"direction": ["0", "0"]}, ""),
    ("several", {"direction": ["1", "-1"]}, ""),  # beyond a row
    ("several", {"direction": ["-1", "0"]}, ""),  # one that costs
]
NOT_JUDGED = [{"active": ("G[0]", "A[0]")}, {"multipliers_unique": True}]
"""What the checker in one file takes: an order of rows, and that multipliers are unique."""


def proved(kind):
    """An answer, or the proof that is raised."""
    if kind in OPTIMUM:
        return qr.exact_qp(**OPTIMUM[kind])
    changes, error = NO_OPTIMUM[kind]
    with pytest.raises(error) as caught:
        qr.exact_qp(**PROGRAM | changes)
    return caught.value


@pytest.mark.parametrize(("kind", "changes", "reason"), FORGED)
def test_a_forged_answer_or_proof_is_refused_by_both_checkers(
    kind, changes, reason, tmp_path, capsys
):
    path = proved(kind).save(tmp_path / "answer.json")
    assert qr.verify(load_answer(path))
    assert said(path, capsys)[0] == 0
    path.write_text(json.dumps(json.loads(path.read_text()) | changes), "utf-8")
    verdict = qr.verify(load_answer(path))
    assert not verdict
    assert reason in verdict.reason
    assert (said(path, capsys)[0] == 0) == (changes in NOT_JUDGED)


def test_one_of_several_optima_is_that_of_least_norm():
    answer = proved("several")
    assert (answer.x.tolist(), answer.least_norm) == ([0.5, 1.5], ("G[0]",))
    assert (answer.x_unique, answer.direction) == (False, ("-1", "1"))


def test_a_proof_of_one_row_says_what_it_asks_for_and_a_false_one_that_it_is_false():
    proof = proved("crossed")
    assert "lb[1] and ub[1] contradict each other by 1 (proved without rounding)" in str(proof)
    false = qr.QPInfeasible(proof.problem, {"lb[1]": "1"})
    assert "is said to have no solution, but the rows of the proof do not add up" in str(false)


def test_the_checker_says_that_a_program_is_too_large(tmp_path, capsys):
    path = qr.exact_qp(np.eye(101), np.ones(101)).save(tmp_path / "answer.json")
    assert said(path, capsys) == (
        2,
        "cannot be judged: a program of 101 unknowns; at most 100 are judged here",
    )


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"x": [1.0]}, "x: must be 2 numbers"),
        ({"version": 1}, "version: is not known here"),
        ({"obj_error": -1.0}, "obj_error: must be at least 0"),
        ({"more": 1}, "more: is unknown"),
        ({"status": "infeasible"}, "farkas: is missing"),
        ({"q": [0.0, []]}, "q: must be numbers"),
        ({"h": [1.0, {}, 9.0]}, "h: must be numbers"),
    ],
)
def test_a_bad_file_gets_one_sentence(changes, sentence, tmp_path):
    path = qr.exact_qp(**PROGRAM).save(tmp_path / "answer.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | changes), "utf-8")
    with pytest.raises(qr.InputError, match=f"answer.json: {sentence}"):
        load_answer(path)
