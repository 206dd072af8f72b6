"""Steps over a pipe are the simulator's, bit for bit; what is wrong is a sentence."""

import io
import json
import shlex
import subprocess
import sys

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.oracle.pipes import lines_served
from quasistatic_ref.lab.oracle.served import ANSWERS, Scenes
from tests.helpers import first_step
from tests.lab.vectors.committed_cases import ROOT
from tests.pages import shell_lines

BALL = [0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 1.0]


def answers(*requests, scenes=("sphere_spin",), settings=()):
    known = Scenes([*settings])
    for scene in scenes:
        known.add(scene)
    lines = [one if isinstance(one, str) else json.dumps(one) for one in requests]
    out = io.StringIO()
    lines_served(known, io.BytesIO("".join(f"{line}\n" for line in lines).encode("latin-1")), out)
    return [json.loads(line) for line in out.getvalue().splitlines()]


def test_a_step_is_the_simulators_and_everything_can_be_asked_of_it():
    first, answer = answers({"id": [1], "q": BALL, "force": [0, 0, 0, 0, 0, 0.02],
                             "ask": [*ANSWERS]})  # fmt: skip
    (scene,) = first["scenes"].values()
    assert scene["q"][:4] == ["sphere.x", "sphere.y", "sphere.z", "sphere.qx"]
    scenario = qr.load_scenario("sphere_spin")
    result = scenario.simulator().step(np.array(BALL), [], np.array([0, 0, 0, 0, 0, 0.02]))
    assert answer["id"] == [1]
    assert answer["q"] == result.q.tolist()
    assert answer["forces"] == result.forces.tolist()
    assert answer["wrench"] == result.solution.wrench.tolist()
    assert answer["certificate"] == answer["solution"]["certificate"]["kind"] == "exact"
    assert answer["contacts"][0]["phi"] == answer["step"]["contacts"][0]["phi"] == 0.0


def test_a_scene_is_sent_once_and_several_are_served():
    tables = {"format": "quasistatic-ref/scenario", "version": 1, "h": 0.01, "steps": 1,
              "bodies": {"ball": {"urdf": str(ROOT / "models/sphere_spin/sphere.urdf"),
                                  "base": "floating", "actuated": []}}}  # fmt: skip
    _, sent, falls, rests, unnamed = answers(
        {"scene": "free", "tables": tables}, {"scene": "free", "q": BALL, "ask": ["q"]},
        {"scene": "sphere_spin", "q": BALL, "ask": ["q"]}, {"q": BALL},
    )  # fmt: skip
    assert sent["scene"] == "free"
    assert sent["contacts"] == []
    assert falls["q"][2] == pytest.approx(0.05 - 9.81 * 0.01**2)  # h^2 g, the model's free fall
    assert rests["q"] == BALL
    assert unnamed["error"] == "scene: is missing: there is not one scene alone"


MISTAKES = {
    "no JSON": ("the line: is not JSON", 2),
    "[]": ("must be a table of named fields", 2),
    '{"q": [1]}': ("q: must be 7 numbers (got [1])", 2),
    '{"qq": [1]}': ("qq: is unknown; did you mean 'q'?", 2),
    '{"q": [0, 0, 0.05, 0, 0, 0, 2]}': ("its quaternion must have length one", 2),
    '{"q": [0, 0, 0.05, 0, 0, 0, NaN]}': ("q: must contain finite numbers only", 2),
    '{"q": [0, 0, 0.05, 0, 0, 0, 1], "ask": ["force"]}': ("did you mean 'forces'?", 2),
    '{"q": [0, 0, -9, 0, 0, 0, 1]}': ("deeper than limits.penetration", 3),
    '{"scene": "ball", "q": []}': ("scene: is not a scene here", 2),
    '{"file": "no_such"}': ("no_such", 2),
    "\xff": ("the line: is not UTF-8 text", 2),
    '{"id": NaN, "q": []}': ("id: must be JSON, which has no such number", 2),
    '{"tables": 3}': ("tables: must be the tables of a scenario", 2),
}


def test_what_cannot_be_is_a_sentence_and_the_next_line_is_answered():
    _, *said, last = answers(*MISTAKES, {"q": BALL, "ask": ["q"]})
    for answer, (words, status) in zip(said, MISTAKES.values(), strict=True):
        assert words in answer["error"]
        assert answer["status"] == status
    assert last == {"q": BALL}


def test_a_server_without_standard_input_says_so(monkeypatch, cli):
    monkeypatch.setattr(sys, "stdin", None)
    assert "standard input: is closed" in cli("serve sphere_spin", status=2).err


@pytest.mark.long
def test_the_line_on_the_page_is_answered_by_the_step_of_the_simulator():
    page = (ROOT / "docs" / "guides" / "check_your_implementation.md").read_text("utf-8")
    (line,) = (one for one in shell_lines(page) if one.startswith("echo "))
    echo, serve = (shlex.split(part) for part in line.split(" | "))
    command = [sys.executable, "-m", "quasistatic_ref", *serve[1:]]
    done = subprocess.run(command, input=echo[1], capture_output=True, text=True, check=True)
    _, answer = (json.loads(one) for one in done.stdout.splitlines())
    assert answer["q"] == first_step(qr.load_scenario("sphere_spin")).q.tolist()
    assert answer["forces"][0][2] == pytest.approx(0.3 * 9.81)  # the weight
