"""``vectors report``: a badge that says exactly what was passed, and holds the record of it."""

import json
import shutil
from xml.etree import ElementTree

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.conformance import badge
from quasistatic_ref.lab.vectors.conformance.conformance import conformance
from quasistatic_ref.lab.vectors.files import answers_written
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.versions import RELEASE
from tests.lab.vectors.committed_cases import VECTORS, cases, right_answers

LABEL = f"quasi-dynamic vectors {RELEASE}"
SIZE = {layer: len(cases(layer)) for layer in LAYERS}
SVG = "{http://www.w3.org/2000/svg}"


def answer_folder(folder, layers, change=lambda layer, output: output, name="my_sim 0.3"):
    """A folder of right answers, changed."""
    for layer in layers:
        outputs = {id: change(layer, output) for id, output in right_answers(layer).items()}
        answers_written(folder, layer, name, outputs)
    return folder


def outcome(answers, digits=None, vectors=VECTORS):
    """What was passed, and the badge that says it."""
    found = conformance(answers, vectors, None, digits)
    return found, badge.badge(found)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """All layers, right."""
    folder = tmp_path_factory.mktemp("whole")
    return outcome(answer_folder(folder / "answers", LAYERS))


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """Two layers, one of them with lam for force."""
    folder = tmp_path_factory.mktemp("two")

    answers = answer_folder(folder / "answers", ("rows", "wrench"))
    h = {case.id: case.input["h"] for case in cases("wrench")}
    forgotten = {
        id: {
            "wrench": (h[id] * np.array(output["wrench"])).tolist(),
            "net": {name: (h[id] * np.array(v)).tolist() for name, v in output["net"].items()},
        }
        for id, output in right_answers("wrench").items()
    }
    answers_written(answers, "wrench", "my_sim 0.3", forgotten)
    return outcome(answers)


def words_of(svg):
    """The texts of a picture that are seen, and its colours."""
    root = ElementTree.fromstring(svg)
    texts = [node.text for node in root.iter(f"{SVG}text")]
    return texts, {node.get("fill") for node in root.iter() if node.get("fill")}


def record_of(svg):
    """The record that a badge holds."""
    return json.loads(ElementTree.fromstring(svg).find(f"{SVG}metadata").text)


def test_all_layers_passed_are_said_as_all_and_counted(whole):
    found, svg = whole
    cases = sum(SIZE.values())
    assert found.message == f"all 9 layers: {cases}/{cases}"
    texts, colours = words_of(svg)
    assert texts == [LABEL, found.message]
    assert badge.GREEN in colours
    assert not {badge.AMBER, badge.RED, badge.GREY} & colours
    record = record_of(svg)
    assert (record["ok"], record["vectors"], record["message"]) == (True, RELEASE, found.message)
    assert [layer["passed"] for layer in record["layers"]] == [*SIZE.values()]


def test_what_is_not_answered_or_fails_is_said(two):
    found, svg = two
    assert found.message.startswith(f"2 of 9 layers: rows {SIZE['rows']}/{SIZE['rows']}, wrench ")
    said = ElementTree.fromstring(svg).find(f"{SVG}desc").text
    silent = ", ".join(name for name in LAYERS if name not in ("rows", "wrench"))
    assert f"nothing is said of them: {silent}" in said
    failed = sum(v.verdict == FAILED for v in found.report.layers[5].verdicts)
    right = SIZE["wrench"] - failed  # those of no load are zero in any unit
    assert failed > 40
    assert found.message.endswith(f"wrench {right}/{SIZE['wrench']}")
    assert badge.RED in words_of(svg)[1]
    assert "lam and force mixed up by h" in said
    record = record_of(svg)
    assert record["ok"] is False
    assert record["layers"][5]["mistakes"][0]["name"] == "lam and force mixed up by h"


@pytest.mark.parametrize(("digits", "number"), [(None, np.float64), (6, np.float32)])
def test_answers_in_part_are_not_counted_as_passed(digits, number, tmp_path):
    def up_to_A_and_b(layer, output):
        return {name: number(output[name]).tolist() for name in ("H", "g", "A", "b")}

    found, svg = outcome(answer_folder(tmp_path / "answers", ["step"], up_to_A_and_b), digits)
    assert found.report.ok
    assert found.message == f"1 of 9 layers: step 0/{SIZE['step']} and {SIZE['step']} in part"
    assert badge.AMBER in words_of(svg)[1]
    assert "nothing is said of contacts, delta_q" in svg


def test_fewer_digits_are_in_the_badge_only_where_they_were_needed(tmp_path):
    def rounded(layer, output):  # as a program in float32 does; `integrate` is answered in float64
        return {k: np.float32(v).tolist() for k, v in output.items()} if layer == "rows" else output

    answers = answer_folder(tmp_path / "answers", ("rows", "integrate"), rounded)
    found, svg = outcome(answers, digits=6)
    sizes = f"rows {SIZE['rows']}/{SIZE['rows']} to 6 digits, integrate {SIZE['integrate']}"
    assert found.message == f"2 of 9 layers: {sizes}/{SIZE['integrate']}"
    assert badge.AMBER in words_of(svg)[1]
    assert "acceptable are answers that are right to 6 digits" in svg
    found, svg = outcome(answers)
    assert not found.report.ok
    assert badge.RED in words_of(svg)[1]
    assert " digits" not in found.message


def test_a_layer_whose_file_is_not_as_it_should_be_is_said_to_be_that(tmp_path):
    answers = answer_folder(tmp_path / "answers", ["rows"])
    content = json.loads((answers / "rows.json").read_text())
    content["answers"].append({"id": "rows/of/another", "output": {}})
    (answers / "rows.json").write_text(json.dumps(content))
    found, svg = outcome(answers)
    assert found.message.endswith("(file not as it should be)")
    assert badge.RED in words_of(svg)[1]


def test_changed_cases_are_no_version(tmp_path):
    vectors = shutil.copytree(VECTORS, tmp_path / "vectors")
    text = (vectors / "expected" / "rows.json").read_text()
    (vectors / "expected" / "rows.json").write_text(text + "\n")
    answers = answer_folder(tmp_path / "answers", ("rows", "selection"))
    _, svg = outcome(answers, vectors=vectors)
    texts, colours = words_of(svg)
    assert texts[0] == f"{LABEL}, changed"
    assert badge.GREY in colours
    assert f"what was passed is not {LABEL}" in svg
    assert [layer["frozen"] for layer in record_of(svg)["layers"][1:4]] == [True, True, False]
    # What is not answered does not count.
    (answers / "rows.json").unlink()
    assert outcome(answers, vectors=vectors)[0].label == LABEL


def test_names_are_escaped_and_two_programs_are_said_to_be_two(tmp_path):
    name = '<script>alert("1")</script> & "x" | `y`'
    _, svg = outcome(answer_folder(tmp_path / "answers", ["selection"], name=name))
    assert ElementTree.fromstring(svg).find(f"{SVG}title").text.startswith(name)
    assert "<script" not in svg
    answers = answer_folder(tmp_path / "two", ["rows"], name="one")
    answer_folder(answers, ["selection"], name="other")
    assert outcome(answers)[0].implementation == "other and one"


def test_the_same_answers_give_the_same_bytes(whole):
    found, svg = whole
    assert badge.badge(found) == svg


def test_the_command_prints_what_was_passed_and_ends_as_the_check(tmp_path, cli):
    answers = answer_folder(tmp_path / "answers", ["selection"])
    out = tmp_path / "badge.svg"
    given = ["vectors", "report", answers, "--out", out]
    said = cli(*given, "--implementation", "other 2").out.splitlines()
    size = SIZE["selection"]
    assert f"{LABEL}: 1 of 9 layers: selection {size}/{size}" in said
    assert said[-1] == f"wrote {out}"
    assert record_of(out.read_text())["implementation"] == "other 2"
    assert cli(*given, "--quiet").out == ""
    content = json.loads((answers / "selection.json").read_text())
    content["answers"][0]["output"]["indices"][0] = [99]
    (answers / "selection.json").write_text(json.dumps(content))
    assert json.loads(cli(*given, "--json", status=1).out)["layers"][1]["failed"] == 1
    assert cli(*given, "--quiet", status=1).err.startswith(
        "quasistatic-ref: 1 of 9 layers: selection "
    )
