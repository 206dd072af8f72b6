"""Answers of quadratic programs in files: checked twice, forged ones refused."""

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import quasistatic_ref as qr
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


KINDS = tomllib.loads(Path(__file__).with_name("forged.toml").read_text("utf-8"))
PROGRAM = KINDS["optimum"]["program"]
FORGED = [
    pytest.param(kind, changes, reason, id=f"{kind}: {changes}")
    for kind, one in KINDS.items()
    for changes, reason in one["forged"]
]
NOT_JUDGED = [{"active": ["G[0]", "A[0]"]}, {"multipliers_unique": True}]
"""What the checker in one file takes: an order of rows, and that multipliers are unique."""


def proved(kind):
    """An answer, or the proof that is raised."""
    one = KINDS[kind]
    if "proof" not in one:
        return qr.exact_qp(**one["program"])
    with pytest.raises(getattr(qr, one["proof"])) as caught:
        qr.exact_qp(**one["program"])
    return caught.value


@pytest.mark.parametrize(("kind", "changes", "reason"), FORGED)
def test_a_forged_answer_or_proof_is_refused_by_both_checkers(
    kind, changes, reason, tmp_path, capsys
):
    path = proved(kind).save(tmp_path / "answer.json")
    assert qr.verify(qr.load_answer(path))
    assert said(path, capsys)[0] == 0
    path.write_text(json.dumps(json.loads(path.read_text()) | changes), "utf-8")
    verdict = qr.verify(qr.load_answer(path))
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
        qr.load_answer(path)
