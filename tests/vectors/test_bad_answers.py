"""Answer files that are missing, cut off, or full of something else; the rest is still checked."""

import json

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.verdict import DIGITS, correct_digits
from tests.tolerances import ROUNDING
from tests.vectors.material import VECTORS, cases, expected, report_on, right_answers

LIGHT = ("selection", "rows", "wrench")


def written(folder, layer, outputs, **head):
    """A file of answers."""
    top = {
        "format": "quasistatic-ref/vectors-answers",
        "version": 1,
        "layer": layer,
        "implementation": "test 0.1",
        "answers": [{"id": name, "output": output} for name, output in outputs.items()],
        **head,
    }
    path = folder / f"{layer}.json"
    path.write_text(json.dumps(top))
    return path


@pytest.fixture
def folder(tmp_path):
    """Right answers to three layers."""
    for layer in LIGHT:
        written(tmp_path, layer, right_answers(layer))
    return tmp_path


def layers(report):
    return {layer.layer: layer for layer in report.layers}


def test_right_answers_pass_and_layers_without_a_file_are_named(folder):
    report = check_answers(folder, VECTORS)
    assert report.ok
    assert report.status == 0
    found = layers(report)
    assert all(found[name].count("passed") == len(cases(name)) for name in LIGHT)
    assert not found["qp"].present
    assert any("qp" in sentence and "not answered" in sentence for sentence in report.sentences)


def test_a_layer_that_is_asked_for_has_to_be_there(folder):
    report = check_answers(folder, VECTORS, ["rows", "qp"])
    assert report.status == 1
    assert any("no qp.json" in sentence for sentence in report.sentences)


def truncated(path):
    path.write_text(path.read_text()[:-200])


def emptied(path):
    path.write_text("")


def a_list(path):
    path.write_text("[1, 2]")


def not_text(path):
    path.write_bytes(b"\xff\xfe\x00\x01")


def of_another_layer(path):
    path.write_text(path.read_text().replace('"layer": "rows"', '"layer": "qp"'))


def of_another_version(path):
    path.write_text(path.read_text().replace('"version": 1', '"version": 2'))


def with_a_misspelt_field(path):
    path.write_text(path.read_text().replace('"implementation"', '"implementer"'))


def in_an_unknown_tangent(path):
    path.write_text(path.read_text().replace('"version"', '"tangent": "spatial", "version"'))


def replaced_by_a_folder(path):
    path.unlink()
    path.mkdir()


BAD_FILES = {
    "truncated": (truncated, "is not JSON"),
    "empty": (emptied, "is not JSON"),
    "a list": (a_list, "table of named fields"),
    "not text": (not_text, "UTF-8"),
    "another layer": (of_another_layer, "layer"),
    "another version": (of_another_version, "version"),
    "a misspelt field": (with_a_misspelt_field, "implementation"),
    "an unknown tangent": (in_an_unknown_tangent, "tangent"),
    "a folder": (replaced_by_a_folder, "cannot be read"),
}


@pytest.mark.parametrize(("spoil", "says"), BAD_FILES.values(), ids=BAD_FILES)
def test_a_bad_file_is_reported_by_name_and_the_rest_is_checked(folder, spoil, says):
    spoil(folder / "rows.json")
    report = check_answers(folder, VECTORS)
    found = layers(report)
    assert report.status == 1
    assert not found["rows"].ok
    assert "rows.json" in found["rows"].trouble
    assert says in found["rows"].trouble
    assert found["rows"].count("missing") == len(cases("rows"))
    assert found["wrench"].ok
    assert found["selection"].ok


def without_a_field(output):
    return {"A": output["A"]}


def with_one_more_field(output):
    return {**output, "c": 1}


def one_row_short(output):
    return {**output, "b": output["b"][:-1]}


def with_nan(output):
    return {**output, "b": [float("nan"), *output["b"][1:]]}


def with_infinity(output):
    return {**output, "b": [float("inf"), *output["b"][1:]]}


def with_null(output):
    return {**output, "b": [None, *output["b"][1:]]}


def with_a_string(output):
    return {**output, "b": [str(output["b"][0]), *output["b"][1:]]}


def with_true(output):
    return {**output, "b": [True, *output["b"][1:]]}


def with_a_huge_integer(output):
    return {**output, "b": [10**400, *output["b"][1:]]}


def flattened(output):
    return {**output, "A": [v for row in output["A"] for v in row]}


def a_number(output):
    return 3.0


def nothing(output):
    return None


BAD_OUTPUTS = {
    without_a_field: "b is missing",
    with_one_more_field: "c is no field",
    one_row_short: "entries",
    with_nan: "finite",
    with_infinity: "finite",
    with_null: "must be a number",
    with_a_string: "must be a number",
    with_true: "must be a number",
    with_a_huge_integer: "finite",
    flattened: "A",
    a_number: "must be an object",
    nothing: "must be an object",
}


@pytest.mark.parametrize(
    ("spoil", "says"), BAD_OUTPUTS.items(), ids=[spoil.__name__ for spoil in BAD_OUTPUTS]
)
def test_one_bad_output_fails_alone(folder, spoil, says):
    answers = right_answers("rows")
    name = next(name for name, output in answers.items() if len(output["b"]) > 3)
    written(folder, "rows", {**answers, name: spoil(answers[name])})
    report = layers(check_answers(folder, VECTORS, LIGHT))["rows"]
    assert (report.count("failed"), report.count("passed")) == (1, len(answers) - 1)
    assert report.first.id == name
    assert says in report.first.reason


def test_a_case_that_is_missing_unknown_or_answered_twice_is_named(folder):
    answers = right_answers("rows")
    first, *rest = answers
    written(folder, "rows", {name: answers[name] for name in rest})
    report = layers(check_answers(folder, VECTORS))["rows"]
    assert report.count("missing") == 1
    assert first in report.trouble
    assert not report.ok

    written(folder, "rows", {**answers, "rows/no_such_case": answers[first]})
    assert "rows/no_such_case" in layers(check_answers(folder, VECTORS))["rows"].trouble

    entries = [{"id": name, "output": answers[name]} for name in [*answers, first]]
    written(folder, "rows", {}, answers=entries)
    assert "twice" in layers(check_answers(folder, VECTORS))["rows"].trouble


BROKEN_IN_CONVERSION = [{"q": 3.0}, {"q": [1.0]}, {"q": ["a"] * 7}, {"q": {}}, {}]


@pytest.mark.parametrize("output", BROKEN_IN_CONVERSION, ids=str)
def test_a_bad_output_is_one_even_where_it_is_converted(tmp_path, output):
    answers = right_answers("integrate")
    name = next(
        case.id
        for case in cases("integrate")
        if case.input["mechanism"]["bodies"][0]["joint"] == "floating"
    )
    written(tmp_path, "integrate", {**answers, name: output}, quaternion="wxyz")
    report = layers(check_answers(tmp_path, VECTORS))["integrate"]
    verdict = next(v for v in report.verdicts if v.id == name)
    assert verdict.verdict == "failed"


def test_the_command_prints_a_table_and_ends_with_status_1(folder, capsys):
    assert main(["vectors", "check", str(folder), "--vectors", str(VECTORS)]) == 0
    assert "rows" in capsys.readouterr().out
    answers = right_answers("rows")
    name = next(name for name, output in answers.items() if output["b"])
    wrong = {**answers[name], "b": [v + 1.0 for v in answers[name]["b"]]}
    written(folder, "rows", {**answers, name: wrong})
    assert main(["vectors", "check", str(folder), "--vectors", str(VECTORS)]) == 1
    printed = capsys.readouterr()
    assert name in printed.out
    assert f"{name}: b[" in printed.err


def test_the_json_report_says_all_of_it(folder, capsys):
    answers = right_answers("rows")
    name = next(name for name, output in answers.items() if output["b"])
    written(folder, "rows", {**answers, name: nothing(answers[name])})
    assert main(["vectors", "check", str(folder), "--vectors", str(VECTORS), "--json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert report["format"] == "quasistatic-ref/vectors-report"
    assert not report["ok"]
    found = {layer["layer"]: layer for layer in report["layers"]}
    assert found["rows"]["first_failure"]["id"] == name
    assert found["rows"]["failed"] == 1
    assert found["selection"]["worst_digits"] == 16
    assert not found["qp"]["answered"]
    assert len(found["rows"]["cases"]) == len(answers)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["no_such_folder"], "no folder of answers"),
        (["EMPTY"], "answers no layer"),
        (["EMPTY", "--layer", "row"], "rows"),
        (["EMPTY", "--vectors", "no_such_folder"], "expected"),
    ],
)
def test_what_is_no_folder_of_answers_or_vectors_is_refused(tmp_path, arguments, says, capsys):
    given = [str(tmp_path) if word == "EMPTY" else word for word in arguments]
    if "--vectors" not in given:
        given += ["--vectors", str(VECTORS)]
    assert main(["vectors", "check", *given]) == 2
    assert says in capsys.readouterr().err


def test_an_error_that_underflows_beside_its_field_is_no_warning():
    # 5e-324 / 2 is 0 in float64, whose logarithm there is none of: all digits are right.
    assert correct_digits(5e-324, 2.0, 0.0) == DIGITS
    assert correct_digits(1.0, 1e-3, 0.0) == correct_digits(1.0, 0.0, 0.0) == 0.0
    np.testing.assert_allclose(correct_digits(1e-5, 1.0, 0.0), 5.0, rtol=ROUNDING)


HOSTILE = {
    # name: (case of qp, field, value from the right answer, words of the reason)
    "lists in lam": ("qp/ellipsoid/flat", "lam", lambda lam: [*lam[:-1], [[]]], "must be a number"),
    "a word in lam": ("qp/ellipsoid/flat", "lam", lambda lam: [*lam[:-1], "x"], "must be a number"),
    "A_lam cut off": ("qp/ellipsoid/flat", "A_lam", lambda A_lam: A_lam[:1], "must have 6 entries"),
    "a lam beyond its cone": (
        "qp/ellipsoid/flat", "lam", lambda lam: [1e308] * len(lam), "lam is another one, and ",
    ),
    "a lam beyond float64": (
        "qp/grasp/0", "lam", lambda lam: [1e308] * len(lam), "A'lam is off by nan",
    ),
    "a list for a claim": (
        "qp/random/2", "certificate",
        lambda certificate: {**certificate, "multipliers_unique": [0.0] * 1000},
        "certificate: multipliers_unique is claimed to be [0.0, 0.0",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("case", "field", "change", "says"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_answer_fails_in_one_sentence(case, field, change, says):
    output = expected("qp")[case]["output"]
    verdict = report_on("qp", {case: {**output, field: change(output[field])}}).first
    assert verdict is not None
    assert says in verdict.reason
    assert len(verdict.reason) < 400
