"""Mistakes planted in programs that work: each is caught, and the checker names it."""

import json
import shlex
import subprocess

import pytest

from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.patched import patched_texts, program
from quasistatic_ref.lab.vectors.check.table import FACTOR, MISTAKES
from quasistatic_ref.lab.vectors.check.table import PATCHES as TABLE
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from tests.lab.vectors.material import (
    by_size,
    cases,
    expected,
    report_on,
    right_answers,
    small_cases,
)
from validation.make import planted_bugs

IMPOSSIBLE = (ArithmeticError, LookupError, TypeError, ValueError)
"""What a patched program raises in cases in which the mistake cannot be made."""
PATCHES = {
    f"{layer}: {name} {number}": (name, layer, patch.replace(FACTOR, "0.01"))
    for name, by_layer in TABLE.items()
    for layer, patches in by_layer.items()
    if layer != "derivative"  # test_derivative_layer.py has them
    for number, patch in enumerate(patches, start=1)
}
NAMED = {
    (name, layer): patch
    for name, layer, patch in reversed(PATCHES.values())
    if layer not in ("distance", "step")  # slower; those of JavaScript are named below
}
"""The first patch of each mistake in each layer."""
ALIKE = ["spin sign", "spin rows exchanged"]
"""Of a wrench: each is the other sign of the torque."""
BUGS = {bug["name"]: bug for bug in planted_bugs.bugs()}


def answered(layer, asked, patch):
    """The answers of the plain program with a patch, case by case."""
    for case in asked:
        try:
            yield case, program(patch)(layer, case.input)
        except IMPOSSIBLE:
            continue


def javascript(layer, asked, command):
    """What a runner in JavaScript answers, by id; nothing of what it does not support."""
    lines = [json.dumps({"id": c.id, "layer": layer, "input": c.input}) for c in asked]
    said = subprocess.run(
        shlex.split(command), input="\n".join(lines), capture_output=True, text=True, check=True
    )
    replies = [json.loads(line) for line in said.stdout.splitlines()[1:]]
    return {reply["id"]: reply["output"] for reply in replies if "output" in reply}


@pytest.mark.parametrize(("name", "layer", "patch"), PATCHES.values(), ids=PATCHES)
def test_a_patch_is_caught_by_the_expected_answers(name, layer, patch):
    assert any(
        case_verdict(layer, case.input, expected(layer)[case.id], output).verdict == FAILED
        for case, output in answered(layer, by_size(layer), patch)
    )


@pytest.mark.parametrize(("name", "layer"), NAMED)
def test_a_patch_is_named(name, layer):
    asked = answered(layer, small_cases(layer), NAMED[name, layer])
    report = report_on(layer, {case.id: output for case, output in asked})
    assert report.count("failed") > 0
    wanted = ALIKE if layer == "wrench" and name in ALIKE else [name]
    assert [mistake.name for mistake in report.mistakes] == wanted


@pytest.mark.extra("node")
@pytest.mark.parametrize("name", BUGS)
def test_a_bug_planted_in_javascript_is_named(name, tmp_path):
    bug = BUGS[name]
    planted_bugs.planted(bug["patch"], tmp_path)
    layer = bug["patch"].partition("\n")[0].partition(": ")[2]
    asked = cases("step") if layer == "step" else small_cases(layer)
    command = planted_bugs.JAVASCRIPT.format(folder=tmp_path)
    report = report_on(layer, javascript(layer, asked, command))
    assert report.count("failed") > 0
    named = [bug["mistake"]] if bug["mistake"] else []  # some have no name
    assert [mistake.name for mistake in report.mistakes] == named


def test_every_mistake_that_is_recognised_is_planted_in_javascript_too():
    known = {one.name for one in MISTAKES if set(one.predictions) - {"derivative"}}
    assert known == {bug["mistake"] for bug in BUGS.values()} - {""}
    assert len(known) == 39


def test_a_patch_whose_line_is_not_in_the_program_is_refused():
    with pytest.raises(ValueError, match="'b = phi' stands 0 times"):
        patched_texts("rows.py:\n- b = phi\n+ b = -phi")


def test_answers_that_are_right_have_no_mistake():
    for layer in ("rows", "jacobian", "selection"):
        report = report_on(layer, right_answers(layer))
        assert report.ok
        assert report.mistakes == ()
