"""Outputs that are no right answer to their case; the other cases are still checked."""

import pytest

from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.verdict import DIGITS, correct_digits
from tests.closeness import assert_relative
from tests.lab.vectors.committed_cases import (
    LIGHT,
    VECTORS,
    answer_file,
    by_layer,
    cases,
    expected_of,
    report_on,
    right_answers,
)
from tests.tolerances import ROUNDING


def first_b(value):
    """The change of an output that replaces the first entry of b."""
    return lambda output: {**output, "b": [value, *output["b"][1:]]}


BAD_OUTPUTS = {
    "without a field": (lambda output: {"A": output["A"]}, "b is missing"),
    "one row short": (lambda output: {**output, "b": output["b"][:-1]}, "entries"),
    "NaN": (first_b(float("nan")), "finite"),
    "infinity": (first_b(float("inf")), "finite"),
    "null": (first_b(None), "must be a number, not null, which many programs write for NaN"),
    "a string": (first_b("0.5"), "must be a number"),
    "true": (first_b(True), "must be a number"),
    "a huge integer": (first_b(10**400), "finite"),
    "flattened": (lambda output: {**output, "A": [v for row in output["A"] for v in row]}, "A"),
    "a number": (lambda output: 3.0, "must be an object"),
    "nothing": (lambda output: None, "must be an object"),
}


@pytest.mark.parametrize(("spoil", "says"), BAD_OUTPUTS.values(), ids=BAD_OUTPUTS)
def test_one_bad_output_fails_alone(folder, spoil, says):
    answers = right_answers("rows")
    name = next(name for name, output in answers.items() if len(output["b"]) > 3)
    answer_file(folder, "rows", {**answers, name: spoil(answers[name])})
    report = by_layer(check_answers(folder, VECTORS, LIGHT))["rows"]
    assert (report.count("failed"), report.count("passed")) == (1, len(answers) - 1)
    assert report.first.id == name
    assert says in report.first.reason


BROKEN_IN_CONVERSION = [{"q": 3.0}, {"q": [1.0]}, {"q": ["a"] * 7}, {"q": {}}, {}]


@pytest.mark.parametrize("output", BROKEN_IN_CONVERSION, ids=str)
def test_a_bad_output_is_one_even_where_it_is_converted(tmp_path, output):
    answers = right_answers("integrate")
    name = next(
        case.id
        for case in cases("integrate")
        if case.input["mechanism"]["bodies"][0]["joint"] == "floating"
    )
    answer_file(tmp_path, "integrate", {**answers, name: output}, quaternion="wxyz")
    report = by_layer(check_answers(tmp_path, VECTORS, ["integrate"]))["integrate"]
    verdict = next(v for v in report.verdicts if v.id == name)
    assert verdict.verdict == "failed"


def test_an_error_that_underflows_relative_to_its_field_is_no_warning():
    # 5e-324 / 2 is 0 in float64, whose logarithm there is none of: all digits are right.
    assert correct_digits(5e-324, 2.0, 0.0) == DIGITS
    assert correct_digits(1.0, 1e-3, 0.0) == correct_digits(1.0, 0.0, 0.0) == 0.0
    assert_relative(correct_digits(1e-5, 1.0, 0.0), 5.0, ROUNDING)


HOSTILE = {
    # name: (case of qp, field, value from the right answer, words of the reason)
    "lists in lam": ("qp/ellipsoid/flat", "lam", lambda lam: [*lam[:-1], [[]]], "must be a number"),
    "a word in lam": ("qp/ellipsoid/flat", "lam", lambda lam: [*lam[:-1], "x"], "must be a number"),
    "A_lam cut off": ("qp/ellipsoid/flat", "A_lam", lambda A_lam: A_lam[:1], "must have 6 entries"),
    "a lam beyond its cone": (
        "qp/ellipsoid/flat", "lam", lambda lam: [1e308] * len(lam), "lam is another one, and ",
    ),
    "a lam beyond float64": (  # sums that overflow are inf or nan, by the order of summation
        "qp/grasp/0", "lam", lambda lam: [1e308] * len(lam), "A'lam is off by ",
    ),
    "a list for a claim": (
        "qp/random/2", "certificate",
        lambda certificate: {**certificate, "multipliers_unique": [0.0] * 1000},
        "certificate: multipliers_unique is claimed to be [0.0, 0.0",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("case", "field", "change", "says"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_answer_fails_in_one_sentence(case, field, change, says):
    output = expected_of("qp")[case]["output"]
    verdict = report_on("qp", {case: {**output, field: change(output[field])}}).first
    assert verdict is not None
    assert says in verdict.reason
    assert len(verdict.reason) < 400
