"""A challenge finds what is wrong, and asks the same cases for the same seed."""

import json
import shlex

import pytest

from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.vectors.challenge.fresh import CHALLENGED, cut_scene, fresh_case
from quasistatic_ref.lab.vectors.challenge.fresh import record_of as fresh_record
from quasistatic_ref.lab.vectors.challenge.random_scenes import SHAPES
from quasistatic_ref.lab.vectors.challenge.run import EDGED, ROUND, UNANSWERED, challenge
from tests.lab.vectors.challenge.programs import command
from tests.lab.vectors.committed_cases import record_of

CURVED = {"cylinder", "cone", "ellipsoid"}
LEVELS = range(3)
"""Easy, plain and hard cases."""


def test_the_same_seed_gives_the_same_findings_and_another_other_cases():
    def first(seed):
        found = challenge(lambda *_: {}, layers=["jacobian"], cases=20, seed=seed)
        return [finding.record for finding in found.findings]

    assert first(3) == first(3)
    assert len(first(3)) == 3
    one, other = (fresh_case("rows", (seed, 0), 1)[0] for seed in (3, 4))
    assert one != other


def test_a_function_that_raises_or_returns_no_output_is_a_finding():
    def raises(name, case):
        raise ZeroDivisionError("no mass")

    (finding,) = challenge(raises, layers=["rows"], cases=1).findings
    assert (finding.kind, finding.reason) == ("error", "ZeroDivisionError: no mass")
    (finding,) = challenge(lambda *_: object(), layers=["rows"], cases=1).findings
    assert finding.kind == "wrong"
    assert challenge(lambda *_: None, layers=["rows"], cases=30).status == 0


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", CHALLENGED)
def test_every_fresh_case_is_the_same_again_and_has_an_answer(name, level):
    case, record = fresh_case(name, (5, level), level)
    assert (case, record) == fresh_case(name, (5, level), level)
    assert record_of(name, json.loads(json.dumps(case))) == record


def test_the_command_writes_counterexamples_that_can_be_asked_again(tmp_path, cli):
    out = tmp_path / "found"
    program = command("wrong", tmp_path)
    ask = f"--command {shlex.quote(program)}"
    asked = f"{ask} --layer selection --cases 1 --quiet --out"
    printed = cli("vectors challenge", asked, out, status=1)
    (folder,) = out.iterdir()
    assert printed.out.splitlines()[-1] == str(folder)
    assert "selection is the first layer that is wrong" in printed.err
    page = (folder / "README.md").read_text()
    (line,) = (line for line in page.splitlines() if "--again" in line)
    wanted = ["--command", program, "--again", str(folder / "counterexample.json")]
    assert shlex.split(line)[3:] == wanted  # as a shell takes it apart
    again = "vectors challenge --again", folder / "counterexample.json"
    (record,) = json.loads(cli(*again, f"{ask} --json", status=1).out)["findings"]
    assert record == json.loads((folder / "counterexample.json").read_text())
    right = command("right", tmp_path)
    cli(*again, f"--command {shlex.quote(right)} --quiet")


@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 12), marks=pytest.mark.long)])
@pytest.mark.parametrize("level", LEVELS)
def test_the_package_and_the_plain_program_agree_on_new_cases(level, seeds):
    """But on curved solids that overlap or touch a solid, which the plain program does not do."""
    for seed in seeds:
        cases = cut_scene((seed, 0), level)
        kinds = {entry["shape"]["kind"] for entry in cases["step"]["shapes"].values()}
        for name in CHALLENGED:
            measured = name in ("distance", "step") and CURVED & kinds
            assert measured or record_of(name, cases[name]), (name, seed)


def overlapping(alpha, beta, rng):
    """An input of the layer `distance`: two shapes at nearly the same place."""
    poses = [{"xyz": rng.uniform(-0.01, 0.01, 3), "quaternion": rng.normal(size=4)} for _ in "ab"]
    return plain(
        {"alpha": {"kind": alpha, **SHAPES[alpha]}, "pose_alpha": poses[0]}
        | {"beta": {"kind": beta, **SHAPES[beta]}, "pose_beta": poses[1]}
    )


SOLIDS = [kind for kind in SHAPES if kind not in ("cloud", "halfspace")]


@pytest.mark.parametrize("alpha", SOLIDS)
def test_overlaps_that_no_case_has_are_said_and_others_have_an_answer(alpha, rng):
    for beta in SOLIDS:
        is_round = [kind in ROUND for kind in (alpha, beta)]
        said = all(is_round) or (any(is_round) and bool({alpha, beta} & {*EDGED}))
        answer = fresh_record("distance", overlapping(alpha, beta, rng))
        assert (answer is None) == said, beta
    assert {*ROUND, *EDGED} <= {*UNANSWERED.replace(",", "").split()}


@pytest.mark.parametrize(("layer", "says"), [("distance", True), ("step", True), ("qp", False)])
def test_the_report_says_which_overlaps_are_not_asked(layer, says, tmp_path, cli):
    program = shlex.quote(command("wrong", tmp_path))
    words = f"vectors challenge --cases 1 --layer {layer} --command {program} --out", tmp_path
    assert (UNANSWERED in cli(*words, status=1).out) == says
    report = json.loads(cli(*words, "--json", status=1).out)
    assert report["not_asked"] == (UNANSWERED if says else "")
