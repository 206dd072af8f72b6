"""The benchmark runs, and measures steps of the scenes that it names."""

import json

import numpy as np
import pytest

from quasistatic_ref.lab.bench.profile import BACKENDS, PARTS, profiles
from quasistatic_ref.lab.bench.report import rows
from quasistatic_ref.lab.bench.scenes import GRAVITY, MU_V, PUSH, H, boxes, held_box
from quasistatic_ref.lab.bench.six import FIGURES, MUJOCO, PLAIN, SCENES
from quasistatic_ref.lab.bench.timing import in_turn, least
from tests.extras import is_missing


@pytest.mark.extra("fast")
def test_a_quick_run_measures_every_figure(tmp_path, cli):
    tables = json.loads(cli("bench", "--quick", "--json", "--out", tmp_path).out)
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


def test_of_several_runs_the_least_time_of_each_round_is_kept():
    runs = [{"a": np.array([1.0, 5.0, 3.0])}, {"a": np.array([4.0, 2.0, 3.0])}]
    assert least(iter(runs))["a"].tolist() == [1.0, 2.0, 3.0]


def test_times_are_taken_in_turn():
    calls = []
    rounds = [{"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}] * 2
    times = in_turn(rounds, repeat=2)
    assert "".join(calls) == "abab" * 2
    assert times["a"].shape == (2,)
    assert (times["a"] > 0).all()


@pytest.mark.parametrize("fast", [False, True])
def test_pushed_boxes_slide_as_a_formula_says(fast):
    """Of a push p m g friction takes mu_v m g by each axis of the pyramid.

    The first step of a slide rises by mu_v times its length along the axes, so that it is
    h^2 (|p_x| + |p_y| - mu_v) g over 2 + mu_v^2, or less along an axis on which it sticks: both
    parts of this push are about as large, and both slide.
    """
    scene = boxes(2)
    moved = scene.simulator("full", fast).step(scene.q, np.zeros(0), scene.force)
    first, second = moved.solution.delta_q.reshape(2, 6)
    assert first.tolist() == second.tolist()
    assert 0 < first[0] < H**2 * GRAVITY * PUSH[0]
    assert first[2] == pytest.approx(MU_V * max(first[0], first[1]), rel=1e-9)


@pytest.mark.extra("engines")
def test_mujoco_s_box_between_fingers_has_the_contacts_that_the_page_says():
    import mujoco

    model, data = held_box(0.01, 0.3)
    mujoco.mj_step(model, data)
    assert data.ncon == 12
    _, of_boxes = boxes(3).model()
    assert of_boxes.qpos.reshape(3, 7)[:, :3].tolist() == boxes(3).q.reshape(3, 7)[:, :3].tolist()


@pytest.mark.extra("fast")
def test_a_profile_has_every_part_of_every_backend():
    taken = profiles(2)
    assert [profile.backend for profile in taken] == [*BACKENDS]
    for profile in taken:
        assert tuple(profile.typical) == PARTS
        assert 0 < profile.solve < 1
        assert 0 <= profile.alone < 1
