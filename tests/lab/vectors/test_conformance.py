"""``vectors report``: page, badge and record say exactly what was passed, and nothing more."""

import json
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.conformance import badge
from quasistatic_ref.lab.vectors.conformance.files import conformance, written
from quasistatic_ref.lab.vectors.files import answers_written
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.versions import RELEASE
from tests.lab.vectors.material import VECTORS, cases, right_answers
from validation.tools.check_site import Page

LABEL = f"quasi-dynamic vectors {RELEASE}"
SIZE = {layer: len(cases(layer)) for layer in LAYERS}
SVG = "{http://www.w3.org/2000/svg}"
BETWEEN = ((0, 6), (6, 9), (9, 12), (12, 15), (15, 17))
"""Digits that the page counts; 16 is in the last."""


def answered(folder, layers, change=lambda layer, output: output, name="my_sim 0.3"):
    """A folder of right answers, changed."""
    for layer in layers:
        outputs = {id: change(layer, output) for id, output in right_answers(layer).items()}
        answers_written(folder, layer, name, outputs)
    return folder


def made(answers, out, digits=None, vectors=VECTORS):
    """What was passed, and the texts of the files that say it."""
    found = conformance(answers, vectors, None, digits)
    return found, {path.name: path.read_text() for path in written(found, answers, out)}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """All layers, right."""
    folder = tmp_path_factory.mktemp("whole")
    return made(answered(folder / "answers", LAYERS), folder / "out")


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """Two layers, one of them with lam for force."""
    folder = tmp_path_factory.mktemp("two")

    answers = answered(folder / "answers", ("rows", "wrench"))
    h = {case.id: case.input["h"] for case in cases("wrench")}
    forgotten = {
        id: {
            "wrench": (h[id] * np.array(output["wrench"])).tolist(),
            "net": {name: (h[id] * np.array(v)).tolist() for name, v in output["net"].items()},
        }
        for id, output in right_answers("wrench").items()
    }
    answers_written(answers, "wrench", "my_sim 0.3", forgotten)
    return made(answers, folder / "out")


def words_of(svg):
    """The texts of a picture that are seen, and its colours."""
    root = ElementTree.fromstring(svg)
    texts = [node.text for node in root.iter(f"{SVG}text")]
    return texts, {node.get("fill") for node in root.iter() if node.get("fill")}


def test_all_layers_passed_are_said_as_all_and_counted(whole):
    found, files = whole
    cases = sum(SIZE.values())
    assert found.message == f"all 9 layers: {cases}/{cases}"
    texts, colours = words_of(files["badge.svg"])
    assert texts == [LABEL, found.message]
    assert badge.GREEN in colours
    assert not {badge.AMBER, badge.RED, badge.GREY} & colours
    record = json.loads(files["report.json"])
    assert (record["ok"], record["vectors"], record["message"]) == (True, RELEASE, found.message)
    assert [layer["passed"] for layer in record["layers"]] == [*SIZE.values()]


def test_layers_without_answers_are_on_the_page_and_not_in_the_badge(two):
    found, files = two
    assert found.message.startswith(f"2 of 9 layers: rows {SIZE['rows']}/{SIZE['rows']}, wrench ")
    silent = ", ".join(name for name in LAYERS if name not in ("rows", "wrench"))
    assert f"Layers that are not answered: {silent}." in files["report.md"]
    row = f"| qp | not answered | {SIZE['qp']} | - | - | - | - | - |"
    assert row in files["report.md"].splitlines()


def test_what_fails_is_counted_red_and_named(two):
    found, files = two
    failed = sum(v.verdict == FAILED for v in found.report.layers[5].verdicts)
    right = SIZE["wrench"] - failed  # those of no load are zero in any unit
    assert failed > 40
    assert found.message.endswith(f"wrench {right}/{SIZE['wrench']}")
    assert badge.RED in words_of(files["badge.svg"])[1]
    for name in ("report.md", "report.html"):
        assert "lam and force mixed up by h" in files[name]
    assert f"| wrench | {failed} wrong |" in files["report.md"]
    assert json.loads(files["report.json"])["ok"] is False


@pytest.mark.parametrize(("digits", "number"), [(None, np.float64), (6, np.float32)])
def test_answers_in_part_are_not_counted_as_passed(digits, number, tmp_path):
    def up_to_A_and_b(layer, output):
        return {name: number(output[name]).tolist() for name in ("H", "g", "A", "b")}

    answers = answered(tmp_path / "answers", ["step"], up_to_A_and_b)
    found, files = made(answers, tmp_path / "out", digits)
    assert found.report.ok
    assert found.message == f"1 of 9 layers: step 0/{SIZE['step']} and {SIZE['step']} in part"
    assert badge.AMBER in words_of(files["badge.svg"])[1]
    assert "nothing is said of contacts, delta_q" in files["report.md"]


def test_fewer_digits_are_in_the_badge_only_where_they_were_needed(tmp_path):
    def rounded(layer, output):  # as a program in float32 does; `integrate` is answered in float64
        return {k: np.float32(v).tolist() for k, v in output.items()} if layer == "rows" else output

    answers = answered(tmp_path / "answers", ("rows", "integrate"), rounded)
    found, files = made(answers, tmp_path / "six", digits=6)
    sizes = f"rows {SIZE['rows']}/{SIZE['rows']} to 6 digits, integrate {SIZE['integrate']}"
    assert found.message == f"2 of 9 layers: {sizes}/{SIZE['integrate']}"
    assert badge.AMBER in words_of(files["badge.svg"])[1]
    assert "right to 6 digits were accepted" in files["report.md"]
    found, files = made(answers, tmp_path / "all")
    assert not found.report.ok
    assert badge.RED in words_of(files["badge.svg"])[1]
    assert " digits" not in found.message


def test_a_layer_whose_file_is_not_as_it_should_be_is_said_to_be_that(tmp_path):
    answers = answered(tmp_path / "answers", ["rows"])
    content = json.loads((answers / "rows.json").read_text())
    content["answers"].append({"id": "rows/of/another", "output": {}})
    (answers / "rows.json").write_text(json.dumps(content))
    found, files = made(answers, tmp_path / "out")
    assert found.message.endswith("(file not as it should be)")
    assert badge.RED in words_of(files["badge.svg"])[1]


def test_changed_cases_are_no_version(tmp_path):
    vectors = shutil.copytree(VECTORS, tmp_path / "vectors")
    text = (vectors / "expected" / "rows.json").read_text()
    (vectors / "expected" / "rows.json").write_text(text + "\n")
    answers = answered(tmp_path / "answers", ("rows", "selection"))
    _, files = made(answers, tmp_path / "out", vectors=vectors)
    texts, colours = words_of(files["badge.svg"])
    assert texts[0] == f"{LABEL}, changed"
    assert badge.GREY in colours
    assert f"what was passed is not {LABEL}" in files["report.md"]
    assert [layer["frozen"] for layer in json.loads(files["report.json"])["layers"][1:4]] == [
        True, True, False,
    ]  # fmt: skip
    # What is not answered does not count.
    (answers / "rows.json").unlink()
    assert made(answers, tmp_path / "out", vectors=vectors)[0].label == LABEL


def test_the_page_loads_nothing_from_elsewhere_and_escapes_names(tmp_path):
    name = '<script>alert("1")</script> & "x" | `y`'
    answers = answered(tmp_path / "answers", ["selection"], name=name)
    _, files = made(answers, tmp_path / "out")
    page = Page(files["report.html"])
    assert all(source.startswith("data:image/svg+xml;base64,") for source in page.loads)
    assert len(page.loads) == 1
    assert all(address.startswith("#") for address in page.links)
    assert "<script" not in files["report.html"]
    assert ElementTree.fromstring(files["badge.svg"]).find(f"{SVG}title").text.startswith(name)
    rows = [line for line in files["report.md"].splitlines() if line.startswith("| implementation")]
    shown = name.replace("<", "&lt;").replace("|", "\\|")
    assert rows == [f"| implementation | {shown} |"]


def test_the_same_answers_give_the_same_bytes(whole, tmp_path):
    found, files = whole
    again = {p.name: p.read_text() for p in written(found, Path(found.report.answers), tmp_path)}
    assert again == files


def test_each_answer_that_is_compared_is_counted_once_by_its_digits(two):
    found, files = two
    rows = [line.strip("| ").split(" | ") for line in files["report.md"].splitlines()]
    for layer in (found.report.layers[3], found.report.layers[5]):
        digits = [v.digits for v in layer.verdicts if v.digits is not None]
        counted = [sum(low <= d < high for d in digits) for low, high in BETWEEN]
        (row,) = (row for row in rows if row[:2] == [layer.layer, layer.worst.id])
        assert row[2] == str(len(digits))
        assert list(map(int, row[5:])) == counted


def test_layers_that_name_two_programs_are_said_to_be_of_both(tmp_path):
    answers = answered(tmp_path / "answers", ["rows"], name="one")
    answered(answers, ["selection"], name="other")
    found, files = made(answers, tmp_path / "out")
    assert found.implementation == "other and one"
    assert "| name in the answers to selection | other |" in files["report.md"]
    answered(answers, ["selection"], name="an\x00other\n")
    found = conformance(answers, VECTORS, "mine")
    page = next(p for p in written(found, answers, tmp_path / "out") if p.name == "report.md")
    assert "| name in the answers to selection | an other |" in page.read_text()


def test_the_command_prints_what_was_passed_and_ends_as_the_check(tmp_path, capsys):
    answers = answered(tmp_path / "answers", ["selection"])
    out = tmp_path / "out"
    given = ["vectors", "report", str(answers), "--out", str(out)]
    assert main([*given, "--implementation", "other 2"]) == 0
    said, *wrote = capsys.readouterr().out.splitlines()
    size = SIZE["selection"]
    assert said == f"{LABEL}: 1 of 9 layers: selection {size}/{size}"
    names = ("report.html", "report.md", "badge.svg", "report.json")
    assert wrote == [f"wrote {out / name}" for name in names]
    assert (out / "report.md").read_text().startswith(f"# other 2 and the {LABEL}\n")
    assert main([*given, "--quiet"]) == 0
    assert capsys.readouterr().out == ""
    content = json.loads((answers / "selection.json").read_text())
    content["answers"][0]["output"]["indices"][0] = [99]
    (answers / "selection.json").write_text(json.dumps(content))
    assert main([*given, "--json"]) == 1
    printed = capsys.readouterr()
    assert json.loads(printed.out)["layers"][1]["failed"] == 1
    assert main([*given, "--quiet"]) == 1
    assert capsys.readouterr().err.startswith("quasistatic-ref: selection: selection/")
