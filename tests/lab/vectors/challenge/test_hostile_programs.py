"""Whatever a program does is survived and reported.

It crashes, hangs, prints garbage, answers twice, late or out of order, floods its standard error.
"""

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.vectors.challenge.diagnosis import GIVEN_UP
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from tests.lab.vectors.challenge.programs import command

HANGS = ("hangs", "holds one answer back", "starts another")
"""What waits for an answer that does not come, after others that did."""
SILENT = ("does not flush", "does not read")
"""What never answers, however long one waits."""
SECONDS = {**dict.fromkeys(HANGS, 0.2), **dict.fromkeys(SILENT, 0.04), "answers late": 0.5}
"""For an answer, ten for others. The late one comes after 0.75, and is a hang after 1."""


def outcome(name, folder):
    program = Program(command(name, folder), timeout=SECONDS.get(name, 10.0))
    return challenge(program, layers=["selection"], cases=12)


def kinds(found):
    return {finding.kind for finding in found.findings}


@pytest.mark.parametrize("name", ["right", "declares"])
def test_a_program_that_is_right_is_left_alone(name, tmp_path):
    found = outcome(name, tmp_path)
    assert (found.findings, found.status) == ([], 0)
    assert found.sent == {"selection": 12}
    assert found.implementation == ("mine 3" if name == "declares" else "")


@pytest.mark.parametrize(
    ("name", "kind", "says"),
    [
        ("crashes", "crash", "ended with status 1: out of memory, or so"),
        ("is killed", "crash", "ended by SIGSEGV"),
        ("hangs", "hang", "no answer within 0.4 s"),
        ("does not flush", "hang", "is each line flushed?"),
        ("prints garbage", "stray", "printed 'NaN detected, resetting', which is no JSON"),
        ("prints nothing else", "garbage", "printed 'hello', which is no JSON"),
        ("answers twice", "stray", "answered 'selection/easy/0-0-0' twice"),
        ("holds one answer back", "hang", "no answer within"),
        ("prints what is no text", "stray", "which is no JSON object on a line"),
        ("closes its output", "crash", "closed its output"),
        ("answers out of order", "stray", "answered 'selection/another', which was not sent"),
        ("refuses", "error", "not today"),
        ("answers neither", "garbage", "an answer has output, error or unsupported"),
        ("wrong", "wrong", "indices"),
        ("starts another", "hang", "no answer within"),
    ],
)
def test_it_is_survived_and_reported(name, kind, says, tmp_path):
    found = outcome(name, tmp_path)
    assert found.status == 1
    assert kind in kinds(found)
    assert any(says in finding.reason for finding in found.findings)
    assert len(found.findings) <= 2


def test_after_a_crash_the_other_cases_are_still_judged(tmp_path):
    found = outcome("is killed", tmp_path)
    # Each fourth line kills it: three cases, and some by which the first of them is made smaller.
    assert found.verdicts["selection", "crash"] == GIVEN_UP
    assert found.verdicts["selection", "passed"] == found.sent["selection"] - GIVEN_UP >= 4
    assert any("was started" in remark for remark in found.remarks)


def test_a_program_that_is_late_goes_on_and_its_other_answers_are_judged(tmp_path):
    found = outcome("answers late", tmp_path)
    # Each fourth of 12 cases is late: three, after the last of which the layer is given up.
    assert found.verdicts["selection", "late"] == GIVEN_UP
    assert found.verdicts["selection", "passed"] == 12 - GIVEN_UP
    assert not any("was started" in remark for remark in found.remarks)
    (finding,) = found.findings
    assert (finding.kind, found.status) == ("late", 1)
    assert finding.reason.endswith("s; 0.5 s are allowed")


def test_a_layer_that_does_not_come_back_is_given_up(tmp_path):
    found = outcome("does not read", tmp_path)
    assert kinds(found) == {"hang"}
    assert found.sent["selection"] == GIVEN_UP
    assert "selection got no further cases: 3 cases came to no answer in time" in found.remarks


def test_a_flood_of_errors_holds_nothing_up_and_is_said(tmp_path):
    found = outcome("floods its standard error", tmp_path)
    assert found.verdicts["selection", "passed"] == 12
    # 12 cases of 20,000 lines of 31 characters.
    assert found.remarks == [f"it wrote {12 * 20_000 * 31 / 2**20:.1f} MiB on its standard error"]
    assert found.status == 0


def test_a_line_without_end_is_garbage(tmp_path, monkeypatch):
    monkeypatch.setattr("quasistatic_ref.lab.vectors.challenge.program.LINE", 2**16)
    assert kinds(outcome("prints a line without end", tmp_path)) & {"garbage", "hang"}


def test_a_program_that_supports_nothing_is_asked_no_further(tmp_path):
    found = outcome("supports nothing", tmp_path)
    assert found.remarks == ["selection is not supported"]
    assert found.sent["selection"] < 12
    assert found.status == 0


def test_layers_that_a_program_does_not_declare_are_unsupported(tmp_path):
    program = Program(command("declares another layer", tmp_path))
    found = challenge(program, layers=["rows", "selection", "wrench"], cases=12)
    assert (found.findings, +found.sent) == ([], {"selection": 12})
    assert found.remarks == ["rows is not supported", "wrench is not supported"]


def test_a_program_that_ends_at_once_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="does not answer: it ended with status 1: licence"):
        outcome("ends at once", tmp_path)


def test_a_first_line_that_cannot_be_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="tangent"):
        outcome("declares nonsense", tmp_path)
