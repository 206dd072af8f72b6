"""What happened in a run: its numbers by hand."""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    InputError,
    Simulator,
    System,
    load_scenario,
    load_trajectory,
    relative_turn,
    rollout,
)
from quasistatic_ref.optional.doctor.did.lines import (
    body_line,
    in_words,
    joint_line,
    lines,
    pair_rows,
)
from quasistatic_ref.optional.doctor.did.numbers import by_name, numbers_of, resolved, rounding_of
from tests.closeness import assert_relative
from tests.files.urdf.urdf_texts import joint, link, robot
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
    assert f"; ends {1e3 * (x[-1] - x[0]):.3g} mm from its start" in printed
    assert ": 0.25; drag about 0.49 of 2.45 N at push; largest boundary layer" in printed


def test_a_shape_that_is_not_of_a_pair_is_answered_by_the_pairs():
    run = load_scenario("block_push", steps=1, fast=True).run(progress=False)
    with pytest.raises(InputError, match=r"^nothing: is no pair; known: .*\("):
        run.pair_forces()["nothing"]


@pytest.mark.parametrize("row", params(rows_of("doctor/numbers.toml")))
def test_run_says_the_numbers_that_a_scene_has_in_closed_form(row):
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


def test_a_body_and_a_joint_have_a_line_and_pairs_are_a_table():
    hands = {f"largest_turn_in_hand_{k}_deg": 0.0625 for k in range(9)}
    ball = {"largest_rotation_deg": 1.5, "ends_from_start_m": 0.25, "largest_rise_mm": 1500.0}
    carried = {"carried_from_s": 0.75, "largest_rotation_carried_deg": 0.5}
    bodies = {"ball": ball | hands | carried, "hinge": {"largest_rotation_deg": 90.0}}
    joints = {f"arm/j{k}": {"ends_from_target_rad": np.pi / 6} for k in range(6)}
    pairs = {"a(b, c)": {"touches_s": 0.5, "slip_m": 0.25}, "d(e, f)": {"touches_s": 0.0}}
    numbers = {"bodies": bodies, "joints": joints, "pairs": pairs}
    first, second, *others = lines(numbers)
    assert first == (
        "ball: turns by 1.5 deg (0.062 in the hand_0, 0.062 in the hand_1, 7 more: see --numbers), "
        "0.5 after t = 0.75 s; ends 250 mm from its start, rises by 1.5 m"
    )
    assert second == "hinge: turns by 90 deg"
    assert others == [
        *(f"arm/j{k}: ends 30 deg from its target" for k in range(4)),
        "2 more joints: see --numbers",
    ]
    assert len(list(lines(numbers, every=True))) == 2 + len(joints)
    assert pair_rows(numbers) == [
        ("pair", "touches [s]", "slip [m]"), ("a(b, c)", "0.5", "0.25"), ("d(e, f)", "0", "-"),
    ]  # fmt: skip


JOINTS = {
    # A spring of 1000 N/m that is 12.2 mm short of 27 mm presses with 12.2 N.
    "stops 12.2 mm before its target (54.8 % of the way); its spring presses with up to 12.2 N": {
        "ends_from_target_m": 0.0122, "share_of_way_left": 0.452, "largest_spring_N": 12.2,
    },
    "stops 3 mm beyond its target; its spring presses with up to 3 N": {
        "ends_from_target_m": 0.003, "share_of_way_left": 0.1, "ends_beyond_target_m": 0.003,
        "largest_spring_N": 3.0,
    },
    "ends 1.5 m from its target": {"ends_from_target_m": 1.5},
    "ends 3 mm from its target; its spring presses with up to 1 N m": {
        "ends_from_target_m": 0.003, "share_of_way_left": 1.25, "largest_spring_Nm": 1.0,
    },
    "reaches its target": {"ends_from_target_m": 0.0, "share_of_way_left": 0.0},
}  # fmt: skip


BODIES = {
    "does not move": {"largest_rotation_deg": 0.0, "ends_from_start_m": 0.0},
    "does not turn": {"largest_rotation_deg": 0.0},
    "does not turn; ends 25.5 mm from its start": {
        "largest_rotation_deg": 0.0, "ends_from_start_m": 0.0255, "largest_rise_mm": 0.0,
    },
    "turns by 675 deg; ends where it started, rises by 1.47 mm": {
        "largest_rotation_deg": 675.2, "ends_from_start_m": 0.0, "largest_rise_mm": 1.47,
    },
}  # fmt: skip


@pytest.mark.parametrize("line", BODIES)
def test_a_body_that_rests_turns_or_moves_is_said_to(line):
    assert body_line(BODIES[line]) == line


@pytest.mark.parametrize("line", JOINTS)
def test_a_joint_stops_before_its_target_beyond_it_or_away_from_it(line):
    assert joint_line(JOINTS[line]) == line


@pytest.mark.parametrize(("force", "side"), [(0.0, "reaches"), (-30.0, "before"), (30.0, "beyond")])
def test_what_a_load_pushes_past_its_target_is_said_to_be_beyond_it(force, side):
    """A slide with K = 1000 N/m, whose target is 0.05 m away, under 30 N along it: 30 mm off."""
    slide = robot(link("a"), link("b"), joint("x", "a", "b", kind="prismatic", axis="1 0 0"))
    system = System([Body("r", slide, actuated="all")])
    simulator = Simulator(system, [], h=0.01, K_q=1000.0, gravity=(0.0, 0.0, 0.0))
    run = rollout(simulator, [0.0], [0.05], 2, force=[force], progress=False)
    (line,) = lines(numbers_of(run, simulator))
    words = {
        "reaches": "reaches its target",
        "before": "stops 30 mm before its target (40 % of the way)",
        "beyond": "stops 30 mm beyond its target",
    }
    spring = "; its spring presses with up to 30 N" if force else ""
    assert line == f"r/x: {words[side]}{spring}"


@pytest.mark.parametrize(
    ("word", "printed"),
    [
        ("spring_Nm", "spring 2.462 N m"),
        ("share_of_way_left", "share of way left 2.462"),
        ("largest_turn_in_left_m_deg", "largest turn in left m 2.462 deg"),
    ],
)
def test_a_number_is_printed_with_its_unit_behind_it(word, printed):
    assert in_words(word, 2.462) == printed
