"""`quasistatic-ref vectors`: its actions, their exit status, and plain refusals."""

import json

import pytest

from tests.lab.vectors.committed_cases import few_written
from tests.made import text_written


@pytest.fixture
def few(tmp_path, cli):
    """A folder of vectors with two cases of each layer, generated."""
    few_written(tmp_path / "source", 2)
    out = tmp_path / "vectors"
    cli("vectors generate --vectors", tmp_path / "source", "--out", out)
    return out


def test_the_packages_own_answers_pass_and_a_changed_one_fails(few, tmp_path, cli):
    answers = tmp_path / "answers"
    cli("vectors own --vectors", few, "--out", answers)
    cli("vectors check", answers, "--vectors", few)
    report = json.loads(
        cli("vectors check", answers, "--vectors", few, "--json").out.splitlines()[-1]
    )
    assert (report["format"], report["ok"]) == ("quasistatic-ref/vectors-report", True)
    worst = {layer["layer"]: layer["worst_digits"] for layer in report["layers"]}
    assert worst["selection"] == 16
    content = json.loads((answers / "qp.json").read_text())
    content["answers"][0]["output"]["delta_q"][0] += 1.0
    (answers / "qp.json").write_text(json.dumps(content))
    assert "qp" in cli("vectors check", answers, "--vectors", few, status=1).err
    cli("vectors own --vectors", few, "--out", tmp_path / "one", "--layer rows")
    assert [path.name for path in (tmp_path / "one").iterdir()] == ["rows.json"]


@pytest.mark.parametrize(
    ("record", "says"),
    [
        ({"format": "quasistatic-ref/vectors-expected"}, "format"),
        ({"more": 1}, "more: is unknown"),
        ({"cases": [{"id": "a", "provenance": "b", "input": {}}] * 2}, "id of two cases"),
        ({"cases": [{"id": "a", "input": {}}]}, "provenance: is missing"),
        (
            {"cases": [{"id": "a", "provenance": "b", "input": {"kind": "shared", "name": "c"}}]},
            "is not a shape of this file",
        ),
    ],
)
def test_a_bad_file_of_inputs_is_refused_by_name(record, says, tmp_path, cli):
    head = {"format": "quasistatic-ref/vectors-inputs", "version": 1, "layer": "distance"}
    text_written(tmp_path / "inputs" / "distance.json", json.dumps(head | {"cases": []} | record))
    errors = cli("vectors generate --vectors", tmp_path, "--out", tmp_path / "o", status=2).err
    assert "distance.json" in errors
    assert says in errors


def test_a_new_case_that_cannot_be_answered_is_named(few, cli):
    path = few / "inputs" / "integrate.json"
    content = json.loads(path.read_text())
    content["cases"][0]["id"] = "integrate/new"
    content["cases"][0]["input"]["mechanism"]["bodies"][0]["joint"] = "screw"
    path.write_text(json.dumps(content))
    said = cli("vectors generate --vectors", few, "--out", few, status=2).err
    assert "integrate/new: has no answer" in said
