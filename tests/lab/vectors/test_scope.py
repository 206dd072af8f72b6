"""What a program says that it does: within it, it is complete or not, and nothing else is asked."""

import time

import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.check.scope import scope_read
from quasistatic_ref.lab.vectors.conformance.badge import AMBER, GREEN, RED, colour
from quasistatic_ref.lab.vectors.conformance.files import conformance
from quasistatic_ref.lab.vectors.files import answers_written
from tests.lab.vectors.material import VECTORS, cases, expected, in_float32, right_answers

HEAD = 'format = "quasistatic-ref/scope"\nversion = 1\n'
BOXES = f"""{HEAD}name = "boxes and half-spaces"
layers = ["distance", "selection", "jacobian", "rows", "wrench", "step"]
shapes = ["box", "halfspace"]
cones = ["pyramid"]
farkas = false
"""
FLOATS = f"""{HEAD}name = "float32"
layers = ["selection", "jacobian", "rows", "wrench", "integrate"]
digits = 4
"""


@pytest.fixture
def scope(tmp_path):
    """A function: a scope from its text."""

    def read(text):
        path = tmp_path / "scope.toml"
        path.write_text(text)
        return scope_read(path)

    return read


def cut_down(folder, scope, change=lambda output: output):
    """The answers of a program that does nothing beyond its scope."""
    for layer in scope.layers:
        inputs = {case.id: case.input for case in cases(layer)}
        own = {name: change(output) for name, output in right_answers(layer).items()
               if scope.holds(layer, inputs[name], expected(layer)[name])}  # fmt: skip
        answers_written(folder, layer, "partial 0.1", own)
    return folder


@pytest.mark.parametrize(("text", "change", "words"), [
    (BOXES, lambda output: output, "boxes and half-spaces: all of 6 layers: "),
    (FLOATS, in_float32, "float32: all of 5 layers: "),
])  # fmt: skip
def test_a_program_that_does_what_it_says_has_a_badge(scope, tmp_path, text, change, words):
    own = scope(text)
    found = conformance(cut_down(tmp_path / "answers", own, change), VECTORS, scope=own)
    assert found.report.ok
    assert found.message.startswith(words)
    assert found.message.endswith(" to 4 digits") == (own.digits == 4)
    assert colour(found) == GREEN
    whole = conformance(tmp_path / "answers", VECTORS)
    assert colour(whole) in (RED, AMBER)


def test_what_is_missing_within_the_scope_is_missing(scope, tmp_path):
    own = scope(BOXES)
    folder = cut_down(tmp_path / "answers", own)
    (folder / "rows.json").unlink()
    found = conformance(folder, VECTORS, scope=own)
    assert colour(found) == RED
    assert "not all of 6 layers" in found.message


@pytest.mark.parametrize(("text", "problem"), [
    (BOXES.replace('"box"', '"bxo"'), "did you mean 'box'"),
    (BOXES.replace('"pyramid"', '"pyramyd"'), "pyramid"),
    (FLOATS.replace("digits = 4", "digits = 17"), "at most 16"),
    (FLOATS + "shape = []", "unknown"),
])  # fmt: skip
def test_a_scope_that_cannot_be_is_refused_in_a_sentence(scope, text, problem):
    with pytest.raises(InputError, match=problem) as refused:
        scope(text)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("layer", ["jacobian", "rows", "wrench"])
def test_digits_of_an_answer_do_not_depend_on_the_digits_that_are_asked_for(layer):
    for case in cases(layer):
        record = expected(layer)[case.id]
        given = in_float32(right_answers(layer)[case.id])
        found = {
            verdict_to_digits(layer, case.input, record, given, digits).digits
            for digits in (3, 4, 5)
        }
        assert len(found) == 1, case.id


def test_a_challenge_asks_what_is_in_the_scope_and_nothing_else(scope):
    asked = []

    def boxes(layer, case):
        asked.append((layer, case))
        return program()(layer, case)

    own = scope(BOXES.replace('"selection", ', "").replace(', "step"', ""))
    outcome = challenge(boxes, scope=own, cases=30)
    assert not outcome.findings
    assert {layer for layer, _ in asked} <= set(own.layers)
    assert all(case.get("cone", "pyramid") == "pyramid" for _, case in asked)
    kinds = {case[s]["kind"] for layer, case in asked if layer == "distance"
             for s in ("alpha", "beta")}  # fmt: skip
    assert kinds <= {"box", "halfspace"}


def test_the_seconds_of_a_challenge_are_kept_with_a_slow_program():
    """A quarter of a second an answer: a round of 6 cases and naming 12 more would take 4.5 s."""

    def slow(layer, case):
        time.sleep(0.25)
        return {"A": [], "b": []}

    began = time.monotonic()
    challenge(slow, layers=["rows"], seconds=1.0)
    assert time.monotonic() - began < 4.0
