"""Runs that were killed go on from what they saved, and end with the bits of any other run."""

import contextlib
import json

import numpy as np
import pytest

from quasistatic_ref import (
    Extension,
    InputError,
    RunFailed,
    load_scenario,
    rollout,
    trajectory_read,
)
from quasistatic_ref.cli.main import main
from quasistatic_ref.formats.npz import json_array
from quasistatic_ref.optional.runs import saved_files
from quasistatic_ref.optional.runs.saved_files import saved_folder, saved_steps
from quasistatic_ref.simulate import rollout as module
from quasistatic_ref.simulate.observer import Observer
from tests.errors.scene import SCENE, SUNK, changed, contents, scene_written

STEPS = 9
COLD_EVERY = 4


class Killed(BaseException):
    """What ends a run here as a signal would: nothing in the package catches it."""


class KilledAt(Observer):
    """Kills a run before a step."""

    def __init__(self, k):
        self.k = k

    def before(self, recorder):
        """Kill it."""
        if recorder.steps == self.k:
            raise Killed


@pytest.fixture(autouse=True)
def _cold_often(monkeypatch):
    monkeypatch.setattr(module, "COLD_EVERY", COLD_EVERY)


@pytest.fixture
def scene(tmp_path):
    return scene_written(tmp_path)


def ran(scenario, path, *, killed_at=None, resume=False, extension=None):
    """A run that saves every step, and is perhaps killed in one of them."""

    def target(t):
        if killed_at is not None and t > (killed_at + 0.5) * scenario.h:
            raise Killed
        return scenario.targets(t)

    with contextlib.suppress(Killed):
        return rollout(
            scenario.simulator(extension), scenario.system.q_start, target, scenario.steps,
            force=scenario.force, record=scenario.record, progress=False,
            save=path, save_every=0.0, resume=resume,
        )  # fmt: skip


def above_the_floor(q):
    """An extension that is one row: the ball rises by no more than 1 mm in a step."""
    return Extension(lambda s: [s.delta_q[3] <= 1e-3])


KINDS = {
    "certified": ({}, None),
    "warm and uncertified": ({"solver.backend": "daqp", "solver.certify": "off"}, None),
    "by splitting": ({"solver.backend": "osqp", "solver.certify": "off", "record": "light"}, None),
    "on the plain path": ({"solver.backend": "osqp", "solver.certify": "off", "fast": False}, None),
    "with an extension": ({}, above_the_floor),
    "under Coulomb's law": ({"law": "coulomb"}, above_the_floor),
    "without a backend": ({"solver.backend": "none"}, None),
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_that_was_ended_twice_ends_with_the_bits_of_one_that_was_not(tmp_path, scene, kind):
    settings, extension = KINDS[kind]
    scenario = load_scenario(scene, {"fast": True, **settings, "steps": STEPS})
    whole = tmp_path / "whole.npz"
    parted = tmp_path / "parted.npz"
    ran(scenario, whole, extension=extension)
    # Before the second cold start, and two steps after it.
    for killed_at in (COLD_EVERY - 1, COLD_EVERY + 2):
        assert ran(scenario, parted, killed_at=killed_at, resume=True, extension=extension) is None
        assert saved_steps(parted) == killed_at
    resumed = ran(scenario, parted, resume=True, extension=extension)
    assert parted.read_bytes() == whole.read_bytes()
    assert {part: len(seconds) for part, seconds in resumed.seconds.items()} == dict.fromkeys(
        ("distances", "rows", "solve", "proof", "integrate"), STEPS
    )


def test_a_killed_run_is_resumed_from_the_command_line(tmp_path, scene, capsys, cli):
    arguments = ["run", str(scene), "--fast", "--set", f"steps={STEPS}"]
    path = tmp_path / "again" / "scene.npz"
    once = tmp_path / "once" / "scene.npz"
    path.parent.mkdir()
    ran(load_scenario(scene, {"steps": STEPS}, fast=True), path, killed_at=5)
    assert main([*arguments, "--out", str(path.parent)]) == 2  # nothing is lost for want of a word
    said = capsys.readouterr().err
    assert "holds the first 5 steps of a run that did not end; go on from there" in said
    captured = cli(*arguments, "--out", path.parent, "--resume", "--json")
    assert captured.err.splitlines()[0] == "goes on from step 5"
    summary = json.loads(captured.out)
    assert (summary["steps"], summary["certified"]) == (STEPS, f"{STEPS} of {STEPS} steps exact")

    assert (
        "nothing is saved" not in cli(*arguments, "--out", once.parent, "--resume", "--quiet").err
    )
    assert path.read_bytes() == once.read_bytes()
    assert not saved_folder(path).exists()


WEIGHT = {"bodies.ball.wrenches": [{"t": 0.0, "force": [0.0, 0.2, 0.0]}]}
OTHERS = {
    # name: (changed fields, what the sentence says)
    "h": ({"h": 0.02}, "differs in h: 0.01 then, 0.02 now"),
    "a shape": (
        {"shapes.floor.halfspace.offset": -0.01}, "differs in shapes of floor(floor, ball/ball#0);",
    ),
    "a contact less": (
        {"contacts": {"floor": SCENE["contacts"]["floor"]}},
        "differs in mu_v of push(rail/plate#0, ball/ball#0): 0.3 then, nothing now",
    ),
    "the judge": ({"solver.certify": "residual"}, "differs in certify: full then, residual now"),
    "targets": (
        {"bodies.rail.targets": [{"t": 0.0, "slide": 0.0}, {"t": 0.1, "slide": 0.03}]},
        "target: is not what the saved steps were taken with, from step 0 on",
    ),
    "wrenches": (WEIGHT, "force: is not what the saved steps were taken with, from step 0 on"),
}  # fmt: skip


@pytest.mark.parametrize("other", OTHERS)
def test_another_run_is_not_resumed_and_what_differs_is_named(tmp_path, scene, other):
    changes, says = OTHERS[other]
    path = tmp_path / "run.npz"
    settings = {"steps": STEPS}
    ran(load_scenario(scene, settings, fast=True), path, killed_at=COLD_EVERY + 1)
    before = sorted(saved_folder(path).iterdir())
    with pytest.raises(InputError) as caught:
        ran(load_scenario(scene, settings | changes, fast=True), path, resume=True)
    assert says in str(caught.value)
    assert sorted(saved_folder(path).iterdir()) == before


def test_a_changed_urdf_another_record_and_another_version_are_named(tmp_path, scene, monkeypatch):
    path = tmp_path / "run.npz"
    ran(load_scenario(scene, fast=True), path, killed_at=2)
    urdf = tmp_path / "ball.urdf"
    text = urdf.read_text()
    urdf.write_text(text.replace('"0.3"', '"0.4"'))
    with pytest.raises(InputError, match=r"differs in bodies\.ball; run what it is of"):
        ran(load_scenario(scene, fast=True), path, resume=True)
    urdf.write_text(text)
    with pytest.raises(InputError, match="differs in record: full then, light now"):
        ran(load_scenario(scene, {"record": "light"}, fast=True), path, resume=True)
    monkeypatch.setattr(saved_files, "__version__", "9.9")
    says = r"differs in version of quasistatic_ref: 0\.1\.0 then, 9\.9 now; run what it is of"
    with pytest.raises(InputError, match=says):
        ran(load_scenario(scene, fast=True), path, resume=True)


@pytest.mark.parametrize("steps", [4, STEPS])
def test_a_resumed_run_may_end_where_it_was_saved_or_later(tmp_path, scene, steps):
    path = tmp_path / "run.npz"
    plain = tmp_path / "plain.npz"
    ran(load_scenario(scene, {"steps": 6}, fast=True), path, killed_at=4)
    other = load_scenario(scene, {"steps": steps}, fast=True)
    ran(other, path, resume=True)
    ran(other, plain)
    assert path.read_bytes() == plain.read_bytes()


def test_a_resumed_run_that_is_shorter_is_refused_and_nothing_is_removed(tmp_path, scene, cli):
    path = tmp_path / "scene.npz"
    ran(load_scenario(scene, {"steps": 6}), path, killed_at=4)
    before = contents(tmp_path)
    assert (
        "holds the first 4 steps of a run, and this one has 3;"
        in cli("run", scene, "--set", "steps=3", "--out", tmp_path, "--resume", status=2).err
    )
    assert contents(tmp_path) == before


@pytest.mark.parametrize("changes", [(), (SUNK,)])
def test_a_run_that_ends_leaves_its_trajectory_and_nothing_else(tmp_path, changes):
    path = tmp_path / "out" / "run.npz"
    with pytest.raises(RunFailed) if changes else contextlib.nullcontext():
        ran(load_scenario(scene_written(tmp_path, changed(SCENE, *changes)), fast=True), path)
    assert [file.name for file in path.parent.iterdir()] == ["run.npz"]


@pytest.mark.parametrize(("every", "kept"), [(0.0, True), (3600.0, False)])
def test_ctrl_c_keeps_the_saved_steps_of_a_run_that_was_long(tmp_path, scene, every, kept):
    scenario = load_scenario(scene, fast=True)
    path = tmp_path / "run.npz"

    def target(t):
        if t > 0.025:
            raise KeyboardInterrupt
        return scenario.targets(t)

    with pytest.raises(RunFailed, match="step 2: interrupted"):
        rollout(
            scenario.simulator(), scenario.system.q_start, target, 3,
            force=scenario.force, progress=False, save=path, save_every=every,
        )  # fmt: skip
    assert saved_steps(path) == (2 if kept else 0)
    assert saved_folder(path).exists() == kept


def test_steps_that_could_not_be_saved_are_saved_with_the_next(tmp_path, scene, monkeypatch):
    honest = saved_files.written_whole
    calls = []

    def now_and_then(path, write):
        calls.append(path.name)
        if len(calls) in (2, 3):
            raise InputError("cannot be written: No space left on device", file=path)
        return honest(path, write)

    monkeypatch.setattr(saved_files, "written_whole", now_and_then)
    path = tmp_path / "run.npz"
    plain = tmp_path / "plain.npz"
    scenario = load_scenario(scene, {"steps": STEPS}, fast=True)
    ran(scenario, path, killed_at=6)
    assert calls == ["000000000.npz", *["000000001.npz"] * 3, "000000004.npz", "000000005.npz"]
    ran(scenario, path, resume=True)
    ran(scenario, plain)
    assert path.read_bytes() == plain.read_bytes()


SPOILT = {
    "cut": lambda file: file.write_bytes(file.read_bytes()[:-100]),
    "another archive": lambda file: np.savez(file, t=np.zeros(3)),
    "a header of words": lambda file: np.savez(file, header=np.frombuffer(b"x", dtype=np.uint8)),
    "no steps": lambda file: np.savez(file, header=json_array({"steps": 0})),
}


@pytest.mark.parametrize("spoil", SPOILT)
def test_a_run_goes_on_from_the_good_files_and_keeps_the_others_aside(
    tmp_path, scene, capsys, cli, spoil
):
    path = tmp_path / "scene.npz"
    whole = tmp_path / "whole" / "scene.npz"
    scenario = load_scenario(scene)
    scenario.run(progress=False, save=whole)  # with the waypoints of the command's runs
    ran(scenario, path, killed_at=2)
    SPOILT[spoil](saved_folder(path) / "000000001.npz")
    left = {file.name: file.read_bytes() for file in saved_folder(path).iterdir()}
    arguments = ["run", str(scene), "--out", str(tmp_path), "--quiet"]
    assert main(arguments) == 2  # nothing is lost for want of a word
    assert "--resume" in capsys.readouterr().err
    said = next(line for line in cli(*arguments, "--resume").err.splitlines() if "kept in" in line)
    aside = tmp_path / "scene.npz.left_out"
    assert f"{saved_folder(path)}/000000001.npz: " in said
    assert f"are kept in {aside};" in said
    kept = {file.name: file.read_bytes() for file in aside.iterdir()}
    assert kept == {"000000001.npz": left["000000001.npz"]}
    assert path.read_bytes() == whole.read_bytes()


def test_two_runs_do_not_write_into_one_folder(tmp_path, scene):
    """The second is refused while the first goes on; when that is killed, its lock is gone."""
    path = tmp_path / "run.npz"
    scenario = load_scenario(scene, {"steps": STEPS}, fast=True)
    said = []

    class Second(Observer):
        def before(self, recorder):
            with pytest.raises(InputError) as caught:
                ran(scenario, path, resume=True)
            said.append(str(caught.value))

    with contextlib.suppress(Killed):
        scenario.run(progress=False, save=path, save_every=0.0, observers=[Second(), KilledAt(3)])
    assert set(said) == {f"{saved_folder(path)}: is being written by another run; wait for its end"}
    ran(scenario, path, resume=True)
    assert len(trajectory_read(path)) == STEPS
