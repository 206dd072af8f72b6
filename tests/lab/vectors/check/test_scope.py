"""What a program says that it does: within it, it is complete or not, and nothing else is asked."""

import time

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.check.scope import scope_read
from quasistatic_ref.lab.vectors.conformance.badge import AMBER, GREEN, RED, colour
from quasistatic_ref.lab.vectors.conformance.conformance import conformance
from quasistatic_ref.lab.vectors.files import answers_written
from tests.lab.vectors.committed_cases import VECTORS, cases, expected_of, in_float32, right_answers

HEAD = 'format = "quasistatic-ref/scope"\nversion = 1\n'
BOXES = f"""{HEAD}name = "boxes and half-spaces"
layers = ["distance", "selection", "jacobian", "rows", "wrench", "step"]
shapes = ["box", "halfspace"]
cones = ["pyramid"]
farkas = false
"""
FLOATS = f"""{HEAD}name = "single"
layers = ["selection", "jacobian", "rows", "wrench", "integrate"]
arithmetic = "float32"
digits = 4
"""
COULOMB = f"""{HEAD}name = "boxes"
law = "coulomb"
shapes = ["box", "halfspace"]
pairs = ["halfspace-box"]
arithmetic = "float32"
digits = 4
"""
"""A simulator of boxes on the ground that rounds to 24 bits, and has no relaxation."""
LAW = "Coulomb's law (kinematics, contacts, H and g)"


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
               if scope.holds(layer, inputs[name], expected_of(layer)[name])}  # fmt: skip
        answers_written(folder, layer, "partial 0.1", own)
    return folder


@pytest.mark.parametrize(("text", "change", "words", "layers"), [
    (BOXES, lambda output: output, "box and halfspace, cone pyramid, no Farkas vectors", 6),
    (FLOATS, in_float32, "float32, to 4 digits", 5),
    (COULOMB, in_float32, f"box on halfspace, {LAW}, float32, to 4 digits", 5),
])  # fmt: skip
def test_a_program_that_does_what_it_says_has_a_badge(scope, tmp_path, text, change, words, layers):
    own = scope(text)
    found = conformance(cut_down(tmp_path / "answers", own, change), VECTORS, scope=own)
    assert found.report.ok, found.report.sentences
    assert found.message.startswith(f"{words}: all of {layers} layers: ")
    assert colour(found) == GREEN
    whole = conformance(tmp_path / "answers", VECTORS)
    assert colour(whole) in (RED, AMBER)


def test_a_scope_of_the_names_words_are_those_of_its_fields(scope):
    """The name is free text; a badge has the words of what is compared."""
    assert scope(f'{HEAD}name = "complete Coulomb LCP simulator"').words == ""
    assert scope(f'{HEAD}name = "all"\nrows = [4]\nlayers = ["rows"]').words == "without torsion"


def test_a_scope_of_few_cases_is_called_that(scope, tmp_path):
    own = scope(f'{HEAD}name = "all"\nlayers = ["derivative"]\npairs = ["cone-cloud"]')
    found = conformance(cut_down(tmp_path / "answers", own), VECTORS, scope=own)
    assert 0 < len(found.layers[0].verdicts) < 5
    assert found.message.endswith(", few cases of derivative")
    assert colour(found) == AMBER


def test_what_an_answer_has_beyond_its_law_is_not_compared(scope, tmp_path):
    """A step under Coulomb's law, and contacts that are wrong all the same."""
    own = scope(COULOMB)

    def changed(output):
        return {**output, "delta_q": [1.0], "lam": None} if "H" in output else output

    folder = cut_down(tmp_path / "answers", own, changed)
    assert conformance(folder, VECTORS, scope=own).report.ok

    def wrong(output):
        if not output.get("contacts"):
            return output
        first, *rest = output["contacts"]
        return {**output, "contacts": [{**first, "phi": first["phi"] + 0.1}, *rest]}

    folder = cut_down(tmp_path / "wrong", own, wrong)
    assert not conformance(folder, VECTORS, scope=own).report.ok


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
    (FLOATS + 'law = "coulomb"', "cannot be compared under Coulomb's law"),
    (FLOATS + "rows = [5]", r"must be \[4\], \[6\] or \[4, 6\]"),
    (FLOATS + 'pairs = ["box-bxo"]', "did you mean 'box'"),
    (FLOATS.replace("float32", "float16"), "float32"),
])  # fmt: skip
def test_a_scope_that_cannot_be_is_refused_in_a_sentence(scope, text, problem):
    with pytest.raises(InputError, match=problem) as refused:
        scope(text)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("layer", ["jacobian", "rows", "wrench"])
def test_digits_of_an_answer_do_not_depend_on_the_digits_that_are_asked_for(layer):
    for case in cases(layer):
        record = expected_of(layer)[case.id]
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
