"""A program that ends, hangs or prints what is no answer is reported and started again."""

import json
import shlex
import signal
import time

import pytest

from quasistatic_ref.lab.processes import descendants
from tests.cases import first
from tests.lab.vectors.challenge.programs import command
from tests.processes import has_ended, started, waited_for

SECONDS = {"hangs": 0.2, "does not read": 0.05}
"""For an answer, ten for others."""
SELECTION = "--layer selection"


@pytest.fixture
def challenged(tmp_path, cli):
    """What is printed of twelve cases that a program is asked."""

    def printed(name, more=SELECTION, status=0):
        words = ("--cases 12 --quiet", more, "--timeout", str(SECONDS.get(name, 10.0)))
        program = "--command", shlex.quote(command(name, tmp_path)), "--out", tmp_path / "found"
        return cli("vectors challenge", *words, *program, status=status)

    return printed


def counts(printed):
    """How many answers of each layer are what, by the table."""
    head, *rows = (line.split() for line in printed.out.splitlines() if line[:1] != "/")
    return [dict(zip(head, row, strict=True)) for row in rows]


RIGHT = [{"layer": "selection", "passed": "12", "failed": "0"}]


def test_a_program_that_is_right_has_no_findings(challenged):
    printed = challenged("right")
    assert (counts(printed), printed.err) == (RIGHT, "")


def test_cases_are_asked_for_some_seconds(tmp_path, cli):
    program = "--command", shlex.quote(command("right", tmp_path)), "--out", tmp_path / "found"
    begin = time.monotonic()
    (row,) = counts(cli("vectors challenge", SELECTION, "--seconds 0.5 --quiet", *program))
    assert time.monotonic() - begin >= 0.5
    assert int(row["passed"]) > 0


@pytest.mark.shared
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
def test_a_program_that_fails_is_reported_three_times(name, kind, words, challenged):
    titles = challenged(name, status=1).err.splitlines()
    assert [f": {kind}: " in title for title in titles[:3]] == [True] * 3
    assert len(titles) == (4 if kind == "wrong" else 3)  # and what is usual of the layer
    assert words in titles[0]


def test_after_an_end_the_other_cases_are_asked(challenged):
    # It answers three cases after each start, and the layer has no more after three findings.
    (row,) = counts(challenged("is killed", status=1))
    assert (row["passed"], row["end"]) == ("9", "3")


def test_a_layer_that_is_not_supported_gets_five_easy_cases_alone(challenged):
    (row,) = counts(challenged("supports nothing"))
    assert (row["passed"], row["unsupported"]) == ("0", "5")


def test_layers_that_a_program_does_not_declare_are_not_asked(challenged):
    layers = "--layer rows --layer selection --layer wrench"
    assert counts(challenged("declares a layer", layers)) == RIGHT
    record = json.loads(challenged("declares a layer", f"{layers} --json").out)
    assert (record["implementation"], record["findings"]) == ("mine 3", [])


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("ends at once", "does not answer: it ended with status 3"),
        ("declares nonsense", "tangent"),  # in its first line
    ],
)
def test_a_program_with_which_no_challenge_begins_is_bad_input(name, words, challenged):
    assert words in challenged(name, status=2).err


@pytest.mark.parametrize("end", first(1, [signal.SIGTERM, signal.SIGHUP]))
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
