"""Answer files that are missing, cut off, or full of something else; the rest is still checked."""

import pytest

from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.usual import usual_sentence
from tests.lab.vectors.committed_cases import (
    LIGHT,
    VECTORS,
    answer_file,
    by_layer,
    cases,
    right_answers,
)

WRENCHES = right_answers("wrench")


def test_right_answers_pass_and_a_layer_without_a_file_is_wrong_where_it_is_asked_for(folder):
    report = check_answers(folder, VECTORS)
    assert report.ok
    assert report.status == 0
    found = by_layer(report)
    assert all(found[name].count("passed") == len(cases(name)) for name in LIGHT)
    assert not found["qp"].present
    assert any("qp" in sentence and "no answers" in sentence for sentence in report.sentences)
    asked = check_answers(folder, VECTORS, ["rows", "qp"])
    assert asked.status == 1
    assert any("no qp.json" in sentence for sentence in asked.sentences)


BAD_FILES = {
    # name: (what becomes of the text, words of the report)
    "truncated": (lambda text: text[:-200], "is not JSON"),
    "another layer": (lambda text: text.replace('r": "rows"', 'r": "qp"'), "layer"),
    "another version": (lambda text: text.replace('"version": 1', '"version": 2'), "version"),
    "a misspelt field": (lambda text: text.replace("implementation", "by"), "implementation"),
    "an unknown tangent": (
        lambda text: text.replace('"version"', '"tangent": "spatial", "version"'),
        "tangent",
    ),
    "a folder": (None, "cannot be read"),
}


@pytest.mark.parametrize(("spoilt", "says"), BAD_FILES.values(), ids=BAD_FILES)
def test_a_bad_file_is_reported_by_name_and_the_rest_is_checked(folder, spoilt, says):
    path = folder / "rows.json"
    text = path.read_text()
    if spoilt is None:
        path.unlink()
        path.mkdir()
    else:
        path.write_text(spoilt(text))
    report = check_answers(folder, VECTORS, LIGHT)
    found = by_layer(report)
    assert report.status == 1
    assert not found["rows"].ok
    assert "rows.json" in found["rows"].trouble
    assert says in found["rows"].trouble
    assert found["rows"].count("missing") == len(cases("rows"))
    assert found["wrench"].ok
    assert found["selection"].ok


def test_a_case_that_is_missing_unknown_or_answered_twice_is_named(folder):
    answers = right_answers("rows")
    first, *rest = answers

    def report(outputs, **head):
        answer_file(folder, "rows", outputs, **head)
        return by_layer(check_answers(folder, VECTORS, ["rows"]))["rows"]

    found = report({name: answers[name] for name in rest})
    assert found.count("missing") == 1
    assert first in found.trouble
    assert not found.ok
    assert "rows/no_such_case" in report({**answers, "rows/no_such_case": answers[first]}).trouble
    entries = [{"id": name, "output": answers[name]} for name in [*answers, first]]
    assert "twice" in report({}, answers=entries).trouble


def test_a_name_of_several_lines_is_said_on_one(folder):
    name = next(one.id for one in cases("qp") if "infeasible" in one.id)
    answer_file(folder, "qp", {name: {**right_answers("qp")[name], "a\nb": 0}})
    report = by_layer(check_answers(folder, VECTORS, only=[name]))
    assert report["qp"].ok
    assert report["qp"].unasked.endswith(r"fields that are not looked at: a\nb")


def test_a_missing_answer_before_a_wrong_one_hides_nothing(folder):
    rows = right_answers("rows")
    rows.popitem()
    answer_file(folder, "rows", rows)
    wrong = {name: {**o, "wrench": [[9.0] * 4] * len(o["wrench"])} for name, o in WRENCHES.items()}
    answer_file(folder, "wrench", wrong)
    report = check_answers(folder, VECTORS, LIGHT)
    assert report.sentences.count(usual_sentence("wrench")) == 1
    assert usual_sentence("rows") not in report.sentences


def test_a_case_that_a_program_leaves_out_is_neither_wrong_nor_missing(folder):
    first, *others = WRENCHES.items()
    answers = [{"id": name, "output": output} for name, output in others]
    answers.append({"id": first[0], "unsupported": True})
    answer_file(folder, "wrench", {}, answers=answers)
    report = check_answers(folder, VECTORS, ["wrench"])
    assert report.status == 0
    says = f"right: wrench {len(others)} of {len(WRENCHES)} (1 not supported)"
    assert report.sentences[-1] == report.verdict == says
