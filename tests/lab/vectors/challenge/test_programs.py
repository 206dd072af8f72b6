"""A program that ends, hangs or prints what is no answer is reported and started again."""

import signal

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.processes import descendants
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.run import EASY_CASES, MOST_FINDINGS, challenge
from tests.lab.vectors.challenge.programs import command
from tests.processes import has_ended, started, waited_for

SECONDS = {"hangs": 0.2, "does not read": 0.05}
"""For an answer, ten for others."""


def outcome(name, folder):
    program = Program(command(name, folder), timeout=SECONDS.get(name, 10.0))
    return challenge(program, layers=["selection"], cases=12)


def test_a_program_that_is_right_has_no_findings(tmp_path):
    found = outcome("right", tmp_path)
    assert (found.findings, found.status, found.implementation) == ([], 0, "")
    assert found.verdicts == {("selection", "passed"): 12}


@pytest.mark.parametrize(
    ("name", "kind", "words"),
    [
        ("wrong", "wrong", "indices"),
        ("ends", "end", "ended with status 3"),
        ("is killed", "end", "ended by SIGSEGV"),
        ("closes its output", "end", "closed its output"),
        ("hangs", "hang", "no answer within 0.2 s"),
        ("does not read", "hang", "no answer within 0.3 s; is each line flushed?"),
        ("prints garbage", "garbage", "printed 'NaN detected, resetting', which is no JSON"),
        ("prints what is no text", "garbage", "which is no JSON object on a line"),
        ("prints a line without end", "garbage", "which is no JSON object on a line"),
        ("answers twice", "garbage", "answered 'selection/easy/0-0' where 'selection/easy/0-1'"),
        ("answers neither", "garbage", "an answer has output, error or unsupported"),
        ("refuses", "error", "not today"),
    ],
)
def test_a_program_that_fails_is_reported(name, kind, words, tmp_path):
    found = outcome(name, tmp_path)
    assert found.status == 1
    assert len(found.findings) == MOST_FINDINGS
    finding, *_ = found.findings
    assert finding.kind == kind
    assert words in finding.reason


def test_after_an_end_the_other_cases_are_asked(tmp_path):
    found = outcome("is killed", tmp_path)
    # It answers three cases after each start, and the layer has no more after three findings.
    assert found.verdicts == {("selection", "passed"): 9, ("selection", "end"): 3}


def test_a_layer_that_is_not_supported_gets_the_easy_cases_alone(tmp_path):
    found = outcome("supports nothing", tmp_path)
    assert found.verdicts == {("selection", "unsupported"): EASY_CASES}
    assert found.status == 0


def test_layers_that_a_program_does_not_declare_are_not_asked(tmp_path):
    program = Program(command("declares a layer", tmp_path))
    found = challenge(program, layers=["rows", "selection", "wrench"], cases=12)
    assert (found.findings, found.verdicts) == ([], {("selection", "passed"): 12})
    assert found.implementation == "mine 3"


def test_a_program_that_ends_at_once_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="does not answer: it ended with status 3"):
        outcome("ends at once", tmp_path)


def test_a_first_line_that_cannot_be_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="tangent"):
        outcome("declares nonsense", tmp_path)


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGHUP])
def test_a_program_that_hangs_is_ended_with_the_challenge(tmp_path, end):
    words = ["vectors", "challenge", "--command", command("hangs", tmp_path), "--timeout", "60"]
    words += ["--layer", "selection", "--seed", "0"]
    code = "import signal, sys, runpy\n"
    code += f"signal.signal({int(end)}, signal.SIG_DFL)\n"  # a process in the background ignores it
    code += f"sys.argv[1:] = {words}\n"
    process = started(f"{code}runpy.run_module('quasistatic_ref', run_name='__main__')", tmp_path)
    waited_for(lambda: len(descendants(process.pid)) == 2)  # it, and what it started
    asked = descendants(process.pid)
    process.send_signal(end)
    assert process.wait(timeout=60) == 128 + end
    waited_for(lambda: all(map(has_ended, asked)))
