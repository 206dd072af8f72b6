"""`quasistatic-ref vectors`: its actions, their exit status, and plain refusals."""

import json

import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.vectors.layers import LAYERS
from tests.lab.vectors.committed_cases import by_size, cases, inputs_file


@pytest.fixture
def few(tmp_path):
    """A folder of vectors with two cases of each layer, generated."""
    for layer in LAYERS:
        # The first quadratic programs have a solution.
        chosen = cases("qp") if layer == "qp" else by_size(layer)
        inputs_file(tmp_path / "source", layer, chosen[:2])
    source = str(tmp_path / "source")
    out = str(tmp_path / "vectors")
    assert main(["vectors", "generate", "--vectors", source, "--out", out]) == 0
    return tmp_path / "vectors"


def test_the_packages_own_answers_pass_and_a_changed_one_fails(few, tmp_path, capsys):
    answers = tmp_path / "answers"
    assert main(["vectors", "own", "--vectors", str(few), "--out", str(answers)]) == 0
    assert main(["vectors", "check", str(answers), "--vectors", str(few)]) == 0
    assert main(["vectors", "check", str(answers), "--vectors", str(few), "--json"]) == 0
    report = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert report["ok"] is True
    content = json.loads((answers / "qp.json").read_text())
    content["answers"][0]["output"]["delta_q"][0] += 1.0
    (answers / "qp.json").write_text(json.dumps(content))
    assert main(["vectors", "check", str(answers), "--vectors", str(few)]) == 1
    assert "qp" in capsys.readouterr().err


def test_one_layer_alone_can_be_answered(few, tmp_path):
    out = tmp_path / "answers"
    arguments = ["vectors", "own", "--vectors", str(few), "--out", str(out), "--layer", "rows"]
    assert main(arguments) == 0
    assert [path.name for path in out.iterdir()] == ["rows.json"]


@pytest.mark.parametrize(
    ("record", "says"),
    [
        ({"format": "quasistatic-ref/vectors-expected"}, "format"),
        ({"version": 2}, "this program reads 1"),
        ({"layer": "rows"}, "layer"),
        ({"more": 1}, "more: is unknown"),
        ({"cases": [{"id": "a", "provenance": "b", "input": {}}] * 2}, "id of two cases"),
        ({"cases": [{"id": "a", "input": {}}]}, "provenance: is missing"),
        (
            {"cases": [{"id": "a", "provenance": "b", "input": {"kind": "shared", "name": "c"}}]},
            "is not a shape of this file",
        ),
    ],
)
def test_a_bad_file_of_inputs_is_refused_by_name(record, says, tmp_path, capsys):
    head = {"format": "quasistatic-ref/vectors-inputs", "version": 1, "layer": "distance"}
    text_written(tmp_path / "inputs" / "distance.json", json.dumps(head | {"cases": []} | record))
    arguments = ["vectors", "generate", "--vectors", str(tmp_path), "--out", str(tmp_path / "o")]
    assert main(arguments) == 2
    errors = capsys.readouterr().err
    assert "distance.json" in errors
    assert says in errors


def test_a_case_that_cannot_be_answered_is_named(few, capsys):
    path = few / "inputs" / "distance.json"
    content = json.loads(path.read_text())
    content["cases"][0]["input"]["alpha"] = {"kind": "blob"}
    path.write_text(json.dumps(content))
    assert main(["vectors", "generate", "--vectors", str(few), "--out", str(few)]) == 2
    assert content["cases"][0]["id"] in capsys.readouterr().err
