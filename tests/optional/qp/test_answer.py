"""Answers of quadratic programs in files: checked twice, forged ones refused."""

import json
import re
from dataclasses import replace

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
FORGED = {
    "x": {"x": [0.65, np.nextafter(0.35, 1)]},
    "z": {"z": [0.0, 0.0, 1e-9]},
    "y": {"y": [0.0]},
    "z_box": {"z_box": [0.0, 1e-300]},
    "obj": {"obj": -1.0},
    "obj_error": {"obj_error": 0.0},
    "active": {"active": ("A[0]",)},
    "an order": {"active": ("G[0]", "A[0]")},
    "a row twice": {"active": ("A[0]", "A[0]", "G[0]")},
    "dependent rows": {"active": ("A[0]", "G[0]", "G[1]")},
    "another row": {"active": ("A[0]", "G[2]")},
    "no equation": {"active": ("G[0]",)},
    "no row": {"active": ("A[0]", "G[7]")},
    "multipliers_unique": {"multipliers_unique": True},
}


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_answer_is_refused(name):
    answer = qr.exact_qp(**PROGRAM)
    assert answer.active == ("A[0]", "G[0]")
    assert qr.verify(answer)
    changes = {
        key: np.array(value, dtype=float) if key in ("x", "z", "y", "z_box") else value
        for key, value in FORGED[name].items()
    }
    assert not qr.verify(replace(answer, **changes))
    assert not qr.verify(replace(answer, problem=replace(answer.problem, q=answer.problem.q * 2)))


@pytest.mark.parametrize("name", [name for name in FORGED if name != "multipliers_unique"])
def test_the_checker_in_one_file_refuses_what_it_judges(name, tmp_path, capsys):
    path = qr.exact_qp(**PROGRAM).save(tmp_path / "answer.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | FORGED[name]), "utf-8")
    assert said(path, capsys)[0] == (0 if name == "an order" else 1)


NO_OPTIMUM = {
    "infeasible": ({"lb": [0.9, 0.2], "A": [[0.0, 0.0]], "b": [0.0], "ub": None}, qr.QPInfeasible),
    "crossed": ({"lb": [0.5, 3.0], "ub": [0.5, 2.0]}, qr.QPInfeasible),
    "unbounded": (
        {"P": np.diag([2.0, 0.0]), "q": [-3.0, 1.0], "A": None, "b": None, "ub": None},
        qr.QPUnbounded,
    ),
    "not convex": ({"P": np.diag([2.0, -3.0])}, qr.QPNotConvex),
}
FORGED_PROOFS = [
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
]


def without_optimum(kind):
    """The program, and the proof that is raised."""
    changes, error = NO_OPTIMUM[kind]
    with pytest.raises(error) as caught:
        qr.exact_qp(**PROGRAM | changes)
    return caught.value


@pytest.mark.parametrize(("kind", "changes", "reason"), FORGED_PROOFS)
def test_a_forged_proof_is_refused_by_both_checkers(kind, changes, reason, tmp_path, capsys):
    proof = without_optimum(kind)
    path = proof.save(tmp_path / "proof.json")
    assert qr.verify(load_answer(path))
    assert said(path, capsys)[0] == 0
    path.write_text(json.dumps(json.loads(path.read_text()) | changes), "utf-8")
    assert reason in qr.verify(load_answer(path)).reason
    assert said(path, capsys)[0] != 0


def test_a_proof_of_one_row_says_what_it_asks_for_and_a_false_one_that_it_is_false():
    proof = without_optimum("crossed")
    assert "lb[1] and ub[1] contradict each other by 1 (proved without rounding)" in str(proof)
    false = qr.QPInfeasible(proof.problem, {"lb[1]": "1"})
    assert "is said to have no solution, but the rows of the proof do not add up" in str(false)


SEVERAL = {"P": np.ones((2, 2)), "q": [-2.0, -2.0], "G": [[1.0, 0.0]], "h": [0.5]}
FORGED_AMONG_SEVERAL = {
    "another optimum": {"x": [0.25, 1.75]},
    "rows of least norm left out": {"least_norm": []},
    "a row of least norm twice": {"least_norm": ["G[0]", "G[0]"]},
    "no row": {"least_norm": ["G[4]"]},
    "a row that does not hold it": {"least_norm": ["lb[0]"]},
    "a row that bears nothing": {"active": ["G[0]"]},
    "no direction": {"direction": ["0", "0"]},
    "beyond a row": {"direction": ["1", "-1"]},
    "a costly direction": {"direction": ["-1", "0"]},
}


@pytest.mark.parametrize("name", FORGED_AMONG_SEVERAL)
def test_a_forged_claim_about_several_optima_is_refused_by_both_checkers(name, tmp_path, capsys):
    answer = qr.exact_qp(**SEVERAL | {"lb": [-1.0, 0.0]})
    assert (answer.x.tolist(), answer.least_norm) == ([0.5, 1.5], ("G[0]",))
    assert (answer.x_unique, answer.direction) == (False, ("-1", "1"))
    path = answer.save(tmp_path / "answer.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | FORGED_AMONG_SEVERAL[name]), "utf-8")
    assert not qr.verify(load_answer(path))
    assert said(path, capsys)[0] != 0


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
