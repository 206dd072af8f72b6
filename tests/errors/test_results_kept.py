"""Results that are there: a run replaces one of its scene that is no longer, and nothing else."""

import numpy as np

from quasistatic_ref import load_trajectory
from tests.cases import cases
from tests.errors.scene import SCENE, SUNK, changed, contents, scene_written

LOST = {
    # name: (changes of the scene, arguments, exit status, what is said)
    "a shorter run": (
        (), ["--set", "steps=2"], 2,
        "scene.npz: is a longer run of this scene, of 3 steps; --replace overwrites it",
    ),
    "another scene": (
        (), ["--set", "contacts.push.mu_v=0.123"], 2,
        "scene.npz: is a run of another scene; --replace overwrites it",
    ),
    "a cone that the backend does not take": (
        (), ["--cone", "ellipsoid", "--backend", "daqp"], 2, "accepts only linear rows",
    ),
    "a run that fails": ((SUNK,), ["--replace"], 3, "the first 0 steps are in {}/scene_failed.npz"),
}  # fmt: skip


@cases("changes, more, status, says", LOST)
def test_a_run_replaces_no_other_run(tmp_path, cli, changes, more, status, says):
    out = tmp_path / "out"
    command = ["run", scene_written(tmp_path), "--out", out, "--quiet"]
    cli(*command)
    before = contents(out)
    scene_written(tmp_path, changed(SCENE, *changes))
    assert says.format(out) in cli(*command, *more, status=status).err
    assert before.items() <= contents(out).items()
    assert status == 3 or contents(out) == before


def test_a_run_of_the_same_scene_is_replaced_and_any_other_where_that_is_asked_for(tmp_path, cli):
    """The way to its answers, and what is kept of them, make no other scene."""
    out = tmp_path / "out"
    command = ["run", scene_written(tmp_path), "--out", out, "--quiet"]
    cli(*command)
    for more in (["--backend", "none"], ["--certify", "off"], ["--set", "record=light"]):
        cli(*command, *more)
    cli(*command, "--set", "steps=4")
    first = load_trajectory(out / "scene.npz").header.scene_sha256
    cli(*command, "--set", "h=0.02", "--set", "steps=1", "--replace")
    run = load_trajectory(out / "scene.npz")
    assert (run.header.h, run.steps) == (0.02, 1)
    assert len(first) == len(run.header.scene_sha256) == 64
    assert first != run.header.scene_sha256
    said = cli(*command[:2], "--out", tmp_path / "run.npz", status=2).err
    assert "--out: is a folder, in which scene.npz is written; name a folder" in said


def test_a_file_of_another_kind_is_not_replaced_by_a_trajectory(tmp_path, cli):
    scene = scene_written(tmp_path)
    points = tmp_path / "scene.npz"
    np.savez(points, points=np.zeros((4, 3)))
    before = points.read_bytes()
    said = cli("run", scene, "--out", tmp_path, status=2).err
    assert "is not a trajectory written by this program: it has no header; it is not rep" in said
    assert points.read_bytes() == before
