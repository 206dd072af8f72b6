"""What happened in a run: its numbers by hand."""

import numpy as np
import pytest

from quasistatic_ref import (
    InputError,
    load_scenario,
    load_trajectory,
    relative_turn,
)
from quasistatic_ref.optional.doctor.did.lines import in_words, lines, pair_rows
from quasistatic_ref.optional.doctor.did.numbers import by_name, numbers_of, resolved, rounding_of
from tests.closeness import assert_relative
from tests.optional.rows import made, params, rows_of


def test_the_turn_in_a_hand_is_that_of_the_two_links():
    scenario = load_scenario("bunny_grasp", steps=60, fast=True)
    trajectory = scenario.run(progress=False)
    angles = np.degrees(relative_turn(scenario.system, trajectory, "bunny", "gripper"))
    numbers = numbers_of(trajectory, scenario)
    assert angles.max() > 1e-6
    turn = by_name(numbers)["bunny.largest_turn_in_gripper_deg"]  # of a sweep
    assert_relative(turn, angles.max(), 1e-6)


def test_run_prints_the_numbers(tmp_path, cli):
    printed = cli("run", "block_push", "--fast", "--set", "steps=60", "--out", tmp_path).out
    x = load_trajectory(tmp_path / "block_push.npz")["q"][:, 1]  # of the block, which does not turn
    assert f"ends from start {x[-1] - x[0]:.4g} m" in printed
    assert ": 0.25; drag about 0.49 of 2.45 N at push; largest boundary layer" in printed


def test_a_shape_that_is_not_of_a_pair_is_answered_by_the_pairs():
    run = load_scenario("block_push", steps=1, fast=True).run(progress=False)
    with pytest.raises(InputError, match=r"^nothing: is no pair; known: .*\("):
        run.pair_forces()["nothing"]


@pytest.mark.parametrize("row", params(rows_of("doctor/numbers.toml")))
def test_numbers_are_those_by_hand(row):
    scenario = made(row)
    said = by_name(numbers_of(scenario.run(progress=False, findings=False), scenario))
    for name, (value, off) in row["numbers"].items():
        assert said[name] == pytest.approx(value, rel=off, abs=off)
    assert said.keys().isdisjoint(row.get("unknown", ()))


def test_numbers_that_float64_does_not_resolve_in_their_scene_are_zero(tmp_path, cli):
    """Three boxes rest, in a scene of 0.1 m: their gaps of 1e-17 m and turns of 1e-14 deg are 0."""
    words = ["--fast", "--set", "steps=5", "--out", tmp_path, "--numbers"]
    printed = cli("run", "stack", *words).out.partition("natural units)")[2]
    assert "least distance" in printed
    assert "e-" not in printed
    stack = load_scenario("stack", steps=5, fast=True)
    limits = rounding_of(stack.run(progress=False, findings=False), stack.system.joints)
    least = np.array([0.5, -0.5, 2.0, -2.0])
    assert_relative(resolved(limits.m * least, limits.m), [0.0, 0.0, 2 * limits.m, -2 * limits.m])
    assert 1e-16 < limits.m < 1e-14
    assert 1e-15 < limits.rad < 1e-14


def test_a_body_has_two_lines_a_joint_one_and_pairs_are_a_table():
    hands = {f"largest_turn_in_hand_{k}_deg": 0.0625 for k in range(9)}
    bodies = {"ball": {"largest_rotation_deg": 1.5, "ends_from_start_m": 0.25} | hands}
    joints = {f"arm/j{k}": {"ends_from_target_rad": 0.5} for k in range(6)}
    pairs = {"a(b, c)": {"touches_s": 0.5, "slip_m": 0.25}, "d(e, f)": {"touches_s": 0.0}}
    numbers = {"bodies": bodies, "joints": joints, "pairs": pairs}
    first, second, *others = lines(numbers)
    assert first == "ball: largest rotation 1.5 deg, ends from start 0.25 m"
    turns = [f"largest turn in hand {k} 0.0625 deg" for k in range(2)]
    assert second == f"    {', '.join(turns)}, 7 more: see --numbers"
    assert others == [
        *(f"arm/j{k}: ends from target 0.5 rad" for k in range(4)),
        "2 more joints: see --numbers",
    ]
    assert len(list(lines(numbers, every=True))) == 2 + len(joints)
    assert pair_rows(numbers) == [
        ("pair", "touches [s]", "slip [m]"), ("a(b, c)", "0.5", "0.25"), ("d(e, f)", "0", "-"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("word", "printed"),
    [
        ("largest_spring_Nm", "largest spring 2.462 N m"),
        ("share_of_way_left", "share of way left 2.462"),
        ("largest_turn_in_left_m_deg", "largest turn in left m 2.462 deg"),
    ],
)
def test_a_number_is_printed_with_its_unit_behind_it(word, printed):
    assert in_words(word, 2.462) == printed
