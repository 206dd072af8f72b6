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


PROOF = {"z": ["0", "1/2", "0"], "y": ["0"], "z_box": ["-1", "-1"]}


@pytest.mark.parametrize(
    ("field", "texts", "reason"),
    [
        ("z", ["0", "-1/2", "0"], "negative entry"),
        ("z", ["1", "1/2", "0"], "is not zero"),
        ("z_box", ["-1", "1"], "infinite"),
        ("z_box", ["-1"], "no list of 2 fractions"),
        ("y", ["1e99"], "no list of 1 fractions"),
    ],
)
def test_a_forged_proof_is_refused(field, texts, reason):
    with pytest.raises(qr.QPInfeasible) as caught:
        qr.exact_qp(**PROGRAM | {"lb": [0.9, 0.2], "A": [[0.0, 0.0]], "b": [0.0], "ub": None})
    assert caught.value.exact == {name: tuple(texts) for name, texts in PROOF.items()}
    verdict = qr.verify(qr.QPInfeasible(caught.value.problem, PROOF | {field: texts}))
    assert reason in verdict.reason


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
        ({"version": 2}, "version: is not known here"),
        ({"obj_error": -1.0}, "obj_error: must be at least 0"),
        ({"more": 1}, "more: is unknown"),
        ({"status": "infeasible"}, "farkas: is missing"),
    ],
)
def test_a_bad_file_gets_one_sentence(changes, sentence, tmp_path):
    path = qr.exact_qp(**PROGRAM).save(tmp_path / "answer.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | changes), "utf-8")
    with pytest.raises(qr.InputError, match=f"answer.json: {sentence}"):
        load_answer(path)
