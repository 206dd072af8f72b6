"""A run that is wrong is told by step, layer, contact and cause; a right one is right."""

import csv
import json

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.oracle.comparison import comparison_of_run
from quasistatic_ref.lab.oracle.run_table import OtherRun, positions, resolution
from quasistatic_ref.lab.oracle.scene_case import SceneCases, states_by
from quasistatic_ref.lab.vectors.check.patched import program
from tests.extras import marked_parameters
from tests.pages import ROOT, flat, printed_blocks

PUSHED = "block_push"
SIGN_OF_B = 'rows.py:\n- b.extend([-c["phi"]] * len(found))\n+ b.extend([c["phi"]] * len(found))'
SCENES = ROOT / "validation" / "scenes"
NAMES = ("free", "joints", "keys", "solids", "gripped", "pushed")
OF_SCENES = [SCENES / f"{name}.toml" for name in NAMES]


def table(path, scenario, q, first=0):
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["t", *positions(scenario)])
        for k, row in enumerate(q, first):
            out.writerow([k * scenario.h, *row.tolist()])
    return path


def run_with(tmp_path, scene, patch, steps):
    scenario = qr.load_scenario(scene)
    made = program(patch)
    q = states_by(scenario, lambda case: made("step", case), steps)
    return table(tmp_path / "run.csv", scenario, q)


OF_ALL_KINDS = marked_parameters([*OF_SCENES, "panda_push"], {"panda_push": "robots"})


@pytest.mark.parametrize("name", OF_ALL_KINDS)
def test_the_plain_program_takes_the_step_of_a_scenario(name):
    scenario = qr.load_scenario(name, steps=1)
    q = states_by(scenario, lambda case: program()("step", case), 1)[-1]
    own = scenario.run(progress=False).q[-1]
    assert np.abs(scenario.system.difference(q, own)).max() < 1e-14


def test_the_packages_own_run_is_right_from_npz_and_from_a_table(tmp_path, cli):
    scene = str(SCENES / "pushed.toml")  # whose targets and wrenches change with time
    scenario = qr.load_scenario(scene, steps=5)
    trajectory = scenario.run(progress=False)
    run = trajectory.save(tmp_path / "run.npz")
    assert "5 steps, each as the reference takes it" in cli("compare", scene, run, "--quiet").out
    path = table(tmp_path / "run.csv", scenario, trajectory.q[1:], first=1)
    assert json.loads(cli("compare", scene, path, "--json").out)["steps"] == 5


def test_a_classic_mistake_is_named_with_its_layer_and_contact(tmp_path, capsys):
    run = run_with(tmp_path, PUSHED, SIGN_OF_B, 40)
    assert main(["compare", PUSHED, str(run), "--quiet"]) == 1
    (shown,) = printed_blocks((ROOT / "docs" / "guides" / "ask_step_by_step.md").read_text())
    assert flat(capsys.readouterr().out) == flat(shown)


def test_where_the_reference_takes_no_step_it_says_why(tmp_path, cli):
    q = qr.load_scenario(PUSHED, ["bodies.block.pose.xyz=[0,0,-0.2]"]).system.q_start
    for states in 1, 2:
        run = table(tmp_path / "run.csv", qr.load_scenario(PUSHED), [q] * states)
        said = cli("compare", PUSHED, str(run), "--quiet", status=1).out
        assert flat(said).startswith("the reference takes no further step: step 0: "), states


def test_numbers_of_few_digits_are_known_as_such_and_rest_is_not():
    moving = np.random.default_rng(1).normal(size=(20, 7))
    assert resolution(moving) == 0.0
    assert resolution(moving.round(6)) == 1e-6
    assert 1e-8 < resolution(moving.astype(np.float32).astype(float)) < 1e-6
    assert resolution(np.tile([0.0, 0.05, 1.0], (20, 1))) == 0.0


BAD = {
    "t": ("t: is not among its columns", lambda rows: [["s", *rows[0][1:]], *rows[1:]]),
    "times": ("t: must grow by h", lambda rows: [*rows[:2], [0.5, *rows[2][1:]], *rows[3:]]),
    "words": ("row 3, ", lambda rows: [*rows[:2], [0.01, "x", *rows[2][2:]], *rows[3:]]),
    "one row": ("is not a run", lambda rows: rows[:1]),
}


@pytest.mark.parametrize(("words", "change"), BAD.values(), ids=BAD)
def test_a_table_that_is_no_run_gets_one_sentence(words, change, tmp_path, cli):
    path = run_with(tmp_path, PUSHED, "", 3)
    rows = list(csv.reader(path.read_text().splitlines()))
    with path.open("w", newline="") as file:
        csv.writer(file).writerows(change(rows))
    assert words in cli("compare", PUSHED, path, status=2).err


def test_a_scene_that_cases_cannot_hold_is_compared_without_causes():
    scenario = qr.load_scenario("sphere_spin", law="coulomb", steps=3)
    q = scenario.run(progress=False).q.copy()
    q[2:, 0] += 1e-3
    found = comparison_of_run(scenario, OtherRun(0, q, 0.0))
    assert (found.first.k, found.causes) == (1, ())


def test_corners_that_cases_lack_are_refused():
    scenario = qr.load_scenario(SCENES / "keys.toml", ["contacts.rod_plane.k=2"])
    with pytest.raises(InputError, match="has 2 contacts of a capsule"):
        SceneCases(scenario)
