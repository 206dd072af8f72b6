"""Answers in part, right to fewer digits, in another order; and the checker's options."""

import copy
import json

import pytest

from tests.cases import first
from tests.lab.vectors.committed_cases import (
    LAYERS,
    NUMPY,
    answer_file,
    cases,
    expected_of,
    in_float32,
    inputs_of,
    plain_answer,
    report_on,
    right_answers,
    small_cases,
    verdict_on,
)

SOLVED = ("delta_q", "lam", "A_lam", "wrench", "q_next", "farkas")
"""What comes after A and b in a step."""
BEFORE_J = tuple(
    f"contacts.{name}" for name in ("pair", "index", "phi", "n", "alpha", "beta", "d1", "d2")
)


def without(output, names):
    """A step without some of its fields, those of its contacts after ``contacts.``."""
    kept = {name: value for name, value in output.items() if name not in names}
    kept["contacts"] = [
        {name: value for name, value in contact.items() if f"contacts.{name}" not in names}
        for contact in output["contacts"]
    ]
    return kept


@pytest.mark.parametrize(("names", "wrong"), [(SOLVED, "g"), (BEFORE_J, "contacts.J")])
def test_a_step_is_judged_for_what_it_contains(names, wrong):
    answers = {name: without(o, names) for name, o in right_answers("step").items()}
    report = report_on("step", answers)
    assert report.count("passed") == len(answers)
    unsaid = report.partial.rpartition("said of ")[2].split(", ")
    assert set(unsaid) <= {*names, "forces"}
    one = next(name for name, output in answers.items() if output["contacts"])
    output = copy.deepcopy(answers[one])
    numbers = output["g"] if wrong == "g" else output["contacts"][0]["J"][0]
    numbers[0] += 1.0
    assert report_on("step", {one: output}).first.field == wrong


@pytest.mark.parametrize(
    ("name", "fields", "verdict", "unsaid"),
    [
        ("derivative/kink/row/limit_x", ["differentiable"], "passed", "reasons"),
        ("derivative/ball/pyramid", ["differentiable", "dq_dq"], "passed", "dq_dtau"),
        ("derivative/ball/pyramid", ["differentiable"], "failed", ""),
    ],
)
def test_a_derivative_is_judged_for_what_it_contains(name, fields, verdict, unsaid):
    output = right_answers("derivative")[name]
    found = verdict_on(name, {field: output[field] for field in fields})
    assert (found.verdict, unsaid in (*found.without, "")) == (verdict, True)


def test_fields_that_follow_from_others_may_be_left_out():
    for layer in ("qp", "step"):
        answers = {
            name: {k: v for k, v in output.items() if k not in ("A_lam", "slack", "forces")}
            for name, output in right_answers(layer).items()
        }
        report = report_on(layer, answers)
        assert (report.count("passed"), report.partial) == (len(answers), "")


def test_fields_that_a_layer_does_not_ask_for_are_named_and_not_looked_at():
    answers = copy.deepcopy(right_answers("step"))
    for output in answers.values():
        output["slack"] = [None]
        for contact in output["contacts"]:
            contact["depth"] = "none"
    report = report_on("step", answers)
    assert report.count("passed") == len(answers)
    assert report.unasked.endswith("that are not looked at: slack, contacts.depth")


@pytest.mark.parametrize("every", first(1, [16, 1]))
@pytest.mark.parametrize("layer", LAYERS)
def test_float32_is_right_to_six_digits_and_not_to_twelve(layer, every):
    # float32 rounds to 2^-24 = 6e-8 of a number: that is below 1e-6 and above 1e-12.
    inexact = 0
    some = cases(layer)[::every]
    for case in some:
        answer = in_float32(right_answers(layer)[case.id])
        verdicts = [verdict_on(case.id, answer, digits).verdict for digits in (None, 6, 12)]
        assert verdicts[1] != "failed", case.id
        inexact += verdicts == ["failed", "acceptable", "failed"]
    assert inexact > 0.3 * len(some) or layer == "selection"


def noisy(value, size, rng):
    """An output each of whose numbers is off by a share of the largest of its list."""
    if isinstance(value, dict):
        return {k: v if k == "index" else noisy(v, size, rng) for k, v in value.items()}
    if isinstance(value, float):
        return value + size * abs(value) * rng.uniform(-1, 1)
    if not isinstance(value, list):
        return value
    if not all(isinstance(one, float) for one in value):
        return [noisy(one, size, rng) for one in value]
    top = max(map(abs, value), default=0.0)
    return [one + size * top * rng.uniform(-1, 1) for one in value]


@pytest.mark.shared
@pytest.mark.parametrize("layer", NUMPY)
def test_noise_of_1e_15_is_rounding_and_of_1e_13_is_right_to_12_digits(layer, rng):
    """On what the plain program answers."""
    refused = 0
    for case in small_cases(layer):
        answer = plain_answer(layer, case.input)
        for size, digits in ((1e-15, None), (1e-13, 12)):
            other = noisy(answer, size, rng)
            verdict = verdict_on(case.id, other, digits)
            assert verdict.verdict != "failed", (case.id, size, verdict)
            refused += verdict_on(case.id, other).verdict == "failed"
    assert refused > 0 or layer == "selection"


OTHER_CONTACTS = ("step/peg_in_hole/240", "step/peg_in_hole/241", "step/patch/scissors")


@pytest.mark.parametrize("name", OTHER_CONTACTS)
def test_other_contacts_that_are_as_near_need_no_index(name):
    """Each is the first candidate that it can be; one that is none is refused."""
    output = without(plain_answer("step", inputs_of(name)), ["contacts.index"])
    assert verdict_on(name, output).verdict == "acceptable"
    first_one, *rest = output["contacts"]
    moved = first_one | {"alpha": [x + 1e-3 for x in first_one["alpha"]]}
    wrong = output | {"contacts": [moved, *rest]}
    assert verdict_on(name, wrong).verdict == "failed"


@pytest.fixture
def answers(tmp_path):
    """Right answers to the layer rows, but for one number."""
    outputs = {name: dict(output) for name, output in right_answers("rows").items()}
    outputs["rows/random/3"]["b"] = [v + 0.5 for v in outputs["rows/random/3"]["b"]]
    answer_file(tmp_path, "rows", outputs)
    return tmp_path


def test_some_cases_can_be_asked_for_by_the_beginning_of_their_ids(answers, cli):
    printed = cli("vectors check", answers, "--only rows/cone --quiet")
    assert (printed.out, printed.err) == ("", "")
    (report,) = json.loads(
        cli("vectors check", answers, "--only rows/random --json", status=1).out
    )["layers"]
    assert [len(report["cases"]), report["failed"]] == [12, 1]
    assert report["first_failure"]["id"] == "rows/random/3"
    answer_file(answers, "wrench", right_answers("wrench"))
    names = ["rows/random/2", cases("wrench")[0].id]
    only = "".join(f"--only {name} " for name in names)
    layers = json.loads(cli("vectors check", answers, only, "--json").out)["layers"]
    assert [one["id"] for layer in layers for one in layer["cases"]] == names


def test_one_case_is_shown_number_by_number(answers, cli):
    printed = cli("vectors check", answers, "--case rows/random/3", status=1).out
    wanted = expected_of("rows")["rows/random/3"]["output"]["b"][0]
    (row,) = (line.split() for line in printed.splitlines() if line.startswith("b[0]"))
    assert row == ["b[0]", repr(wanted), repr(wanted + 0.5), "0.5"]
    assert "A[0]" not in printed
    assert (
        f"{sum(map(len, expected_of('rows')['rows/random/3']['output']['A']))} the same" in printed
    )
