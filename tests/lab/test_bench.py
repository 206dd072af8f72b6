"""The benchmark runs, and measures steps of the scenes that it names."""

import json

import pytest

from quasistatic_ref.lab.bench.profile import BACKENDS, PARTS, profiles
from quasistatic_ref.lab.bench.report import rows
from quasistatic_ref.lab.bench.scenes import boxes, held_box
from quasistatic_ref.lab.bench.six import FIGURES, MUJOCO, PLAIN, SCENES
from quasistatic_ref.lab.bench.timing import in_turn
from tests.extras import is_missing


def test_a_quick_run_measures_every_figure(tmp_path, cli):
    tables = json.loads(cli("bench --quick --json --out", tmp_path).out)
    assert json.loads((tmp_path / "bench.json").read_text()) == tables
    assert list(tables["scenes"]) == [*SCENES][:2]
    without = {MUJOCO} if is_missing("engines") else set()
    for own in tables["scenes"].values():
        assert set(own) == {*FIGURES} - without
        assert min(own.values()) > 0
    grasp = tables["scenes"]["the grasp"]
    assert f"| the grasp | {grasp[PLAIN]:.0f} | " in (tmp_path / "bench.md").read_text()


def test_a_figure_that_was_not_measured_is_a_dash_and_growth_stands_below():
    scenes = {"10 boxes": {PLAIN: 4.4, MUJOCO: 1.0}, "40 boxes": {PLAIN: 19.8}}
    head, few, many, growth = rows(scenes)
    assert head == ("[us]", *FIGURES)
    assert few[:2] == ("10 boxes", "4")
    assert many == ("40 boxes", "20", *"-----")
    assert growth == ("40 boxes over 10", "x 4.5", *"-----")


def test_times_are_taken_in_turn():
    calls = []
    rounds = [{"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}] * 2
    times = in_turn(rounds, repeat=2)
    assert "".join(calls) == "abab" * 2
    assert times["a"].shape == (2,)
    assert (times["a"] > 0).all()


@pytest.mark.extra("engines")
def test_mujoco_s_box_between_fingers_has_the_contacts_that_the_page_says():
    import mujoco

    model, data = held_box(0.01, 0.3)
    mujoco.mj_step(model, data)
    assert data.ncon == 12
    _, of_boxes = boxes(3).model()
    assert of_boxes.qpos.reshape(3, 7)[:, :3].tolist() == boxes(3).q.reshape(3, 7)[:, :3].tolist()


def test_a_profile_has_every_part_of_every_backend():
    taken = profiles(2)
    assert [profile.backend for profile in taken] == [*BACKENDS]
    for profile in taken:
        assert tuple(profile.typical) == PARTS
        assert 0 < profile.solve < 1
        assert 0 <= profile.alone < 1
