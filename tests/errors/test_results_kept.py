"""Results that are there: no run replaces a longer one, nor a file of another kind."""

import numpy as np

from tests.cases import cases
from tests.errors.scene import SCENE, SUNK, changed, contents, scene_written

LOST = {
    # name: (changes of the scene, arguments, exit status, what is said)
    "a shorter run": ((), ["--set", "steps=2"], 2, "scene.npz: holds a run of 3 steps, which one"),
    "a cone that the backend does not take": (
        (), ["--cone", "ellipsoid", "--backend", "daqp"], 2, "accepts only linear rows",
    ),
    "a run that fails": ((SUNK,), [], 3, "the first 0 steps are in {}/scene_failed.npz"),
}  # fmt: skip


@cases("changes, more, status, says", LOST)
def test_a_run_never_replaces_a_longer_one(tmp_path, cli, changes, more, status, says):
    out = tmp_path / "out"
    command = ["run", scene_written(tmp_path), "--out", out, "--quiet"]
    cli(*command)
    before = contents(out)
    scene_written(tmp_path, changed(SCENE, *changes))
    assert says.format(out) in cli(*command, *more, status=status).err
    assert before.items() <= contents(out).items()
    assert status == 3 or contents(out) == before


def test_what_is_no_trajectory_is_not_replaced_by_one(tmp_path, cli):
    scene = scene_written(tmp_path)
    points = tmp_path / "scene.npz"
    np.savez(points, points=np.zeros((4, 3)))
    before = points.read_bytes()
    said = cli("run", scene, "--out", tmp_path, status=2).err
    assert "is not a trajectory written by this program: it has no header; it is not rep" in said
    assert points.read_bytes() == before
