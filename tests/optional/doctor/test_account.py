"""The account of a run: every number of it equals one computed from the npz."""

import json
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import (
    InputError,
    Trajectory,
    load_scenario,
    load_trajectory,
    relative_turn,
    save_trajectory,
)
from quasistatic_ref.optional.doctor.account import SLIDES, SPINS, TOUCHES
from quasistatic_ref.optional.doctor.telling import lines, measures
from tests.closeness import assert_relative
from tests.optional.doctor.words import TIP, block, driven, free, scene, slides
from tests.tolerances import ROUNDING

RUNS = {"bunny_grasp": 110, "door": 120}


@pytest.fixture(scope="module", params=RUNS)
def run(request, tmp_path_factory):
    """A run from its file, which holds forces."""
    scenario = load_scenario(request.param, steps=RUNS[request.param], fast=True, record="forces")
    path = save_trajectory(tmp_path_factory.mktemp("run") / "run.npz", scenario.run(progress=False))
    return load_trajectory(path)


def test_numbers_of_pairs_are_those_of_the_arrays(run):
    """In the pyramid, whose rows and gauge are written out here."""
    assert run.header.cone == "pyramid"
    numbers = run.account().numbers["pairs"]
    h = run.header.h
    pairs = np.array([slot.rpartition("/")[0] for slot in run.header.slots])
    assert list(numbers) == list(dict.fromkeys(pairs.tolist()))
    mu_omega = np.where(run["rows"] == 6, run["mu_omega"], 0.0)
    mu = np.stack([run["mu_v"], run["mu_v"], mu_omega], axis=1)
    n, d1, d2 = (np.vecdot(run["motion"][:, :, :3], run[axis]) for axis in ("n", "d1", "d2"))
    turn = np.abs(run["motion"][:, :, 3]) * (run["rows"] == 6)
    slack = run["phi"] + n - np.abs(mu * np.stack([d1, d2, turn], axis=2)).max(axis=2)
    rubs = np.abs(run["forces"][:, :, [0, 1, 3]])
    needs = np.divide(rubs, mu, out=np.zeros_like(rubs), where=mu > 0).sum(axis=2)
    for name, of_pair in numbers.items():
        own = pairs == name
        apart = slack[:, own] > TOUCHES
        slip, spin = (
            np.ma.array(values[:, own], mask=apart).mean(axis=1).filled(0.0)
            for values in (np.hypot(d1, d2), turn)
        )
        normal = run["forces"][:, own, 2].sum(axis=1)
        share = needs[:, own].sum(axis=1) / np.where(normal > 0, normal, np.inf)
        touching = run["t"][~apart.all(axis=1)]
        expected = {
            "least_distance_m": run["phi"][:, own].min(),
            "touches_s": h * len(touching),
            "slides_s": h * (slip > SLIDES * h).sum(),
            "slip_m": slip.sum(),
            "spins_s": h * (spin > SPINS * h).sum(),
            "turn_deg": np.degrees(spin.sum()),
            "largest_normal_N": normal.max(),
            "largest_friction_N": np.hypot(rubs[:, own, 0], rubs[:, own, 1]).sum(axis=1).max(),
            "largest_torque_Nm": rubs[:, own, 2].sum(axis=1).max(),
            "largest_share": share.max(),
        }
        if len(touching):
            expected |= {"first_touch_s": touching[0], "last_touch_s": touching[-1]}
        assert of_pair == pytest.approx(expected, rel=1e-12, abs=1e-15)


def test_numbers_of_bodies_and_joints_are_those_of_the_arrays(run):
    numbers = run.account().numbers
    names = run.header.positions
    for name, of_body in numbers["bodies"].items():
        if f"{name}.x [m]" in names:
            first = names.index(f"{name}.x [m]")
            moved = run["q"][:, first : first + 3] - run["q"][0, first : first + 3]
            assert of_body["ends_from_start_m"] == np.linalg.norm(moved[-1])
            assert of_body["largest_rise_mm"] == 1e3 * moved[:, 2].max()
            quaternion = run["q"][:, first + 3 : first + 7]
            # The angle between two quaternions: 2 acos |a . b|, which is good to 1e-7 near 0.
            angle = 2 * np.arccos(np.abs(quaternion @ quaternion[0]).clip(0, 1))
            assert abs(of_body["largest_rotation_deg"] - np.degrees(angle.max())) <= 1e-5
        else:
            value = run["q"][:, names.index(f"{name} [rad]")]
            angle = np.degrees(np.abs(value - value[0]).max())
            assert_relative(of_body["largest_rotation_deg"], angle, ROUNDING)
    for name, of_joint in numbers["joints"].items():
        if f"{name} [m]" in names:
            i = names.index(f"{name} [m]")
            error = np.abs(run["q"][1:, i] - run["q_bar_a"][:, i])
            assert of_joint["ends_from_target_m"] == error[-1]
            K_q = run.header.scene["stiffness"][run.header.coordinates.index(name)]
            assert_relative(of_joint["largest_spring_N"], K_q * error.max(), ROUNDING)


@pytest.mark.parametrize(("way", "depth", "left"), [
    (0.01, 0.01, 1.0), (0.02, 0.015, 0.75), (1e-12, 0.0, 0.0),  # none: a target that is held
])  # fmt: skip
def test_how_much_of_its_way_a_joint_has_left(way, depth, left):
    """A slide whose target goes down by `way`, of which a floor takes `depth`: 0 of 10 mm."""
    targets = [{"t": 0.0, "z": 0.0}, {"t": 0.05, "z": -way}]
    finger = driven(slides("z", TIP), (0, 0, 0.01 + way - depth), {"z": 1e3}, targets)
    on = {"on": ("floor", "finger/tip", 0.5, 1)}
    run = scene({"finger": finger}, on, 10).run(progress=False)
    numbers = run.account().numbers["joints"]["finger/z"]
    assert numbers["ends_from_target_m"] == pytest.approx(depth, rel=1e-9)
    assert numbers.get("share_of_way_left", 0.0) == pytest.approx(left, rel=1e-9)


def test_the_turn_in_a_hand_is_that_of_the_two_links():
    scenario = load_scenario("bunny_grasp", steps=60, fast=True)
    trajectory = scenario.run(progress=False)
    angles = np.degrees(relative_turn(scenario.system, trajectory, "bunny", "gripper"))
    numbers = trajectory.account().numbers["bodies"]["bunny"]
    assert angles.max() > 1e-6
    assert_relative(numbers["largest_turn_in_gripper_deg"], angles.max(), 1e-6)
    assert measures(trajectory.account())["bunny.largest_turn_in_gripper_deg"] > 0  # of a sweep


def test_a_full_record_gives_the_account_of_a_record_of_forces():
    full, forces = (
        load_scenario("door", steps=60, fast=True, record=record).run(progress=False)
        for record in ("full", "forces")
    )
    assert full.account().numbers == forces.account().numbers
    bare = {name: array for name, array in full.arrays.items() if name != "forces"}
    assert replace(full, arrays=bare).account(forces=False).pairs[0].loads is None


def test_the_table_is_a_frame(run):
    account = run.account()
    frame = account.to_pandas()
    for kind, names in account.numbers.items():
        for name, numbers in names.items():
            assert frame.loc[kind, name].dropna().to_dict() == numbers


def test_a_light_record_says_what_is_missing():
    light = load_scenario("block_push", steps=60, fast=True, record="light").run(progress=False)
    account = light.account()
    assert all(pair.loads is None and pair.slip is None for pair in account.pairs)
    said = list(lines(account))
    assert "missing: a light record holds no forces: run again with record = 'forces'" in said
    assert any(line.startswith("missing: a light record has no slips") for line in said)


def test_a_file_from_before_there_were_accounts_is_refused(run):
    old = Trajectory(replace(run.header, scene=None), run.arrays)
    with pytest.raises(InputError, match=r"^scene: has no scene: .* run it again"):
        old.account()
    hostile = Trajectory(replace(run.header, scene={"pairs": 3}), run.arrays)
    with pytest.raises(InputError, match=r"scene\.stiffness"):
        hostile.account()


def test_the_commands_print_the_table_and_draw_it(tmp_path, cli):
    short = cli("run", "block_push", "--fast", "--set", "steps=60", "--out", tmp_path).out
    path = tmp_path / "block_push.npz"
    png = tmp_path / "figure.png"
    whole = cli("account", path, "--figure", png).out
    run = load_trajectory(path)
    x = run["q"][:, 1]  # of the block, which does not turn
    for printed in (short, whole):
        assert f"ends_from_start_m {x[-1] - x[0]:.4g}" in printed
    assert png.read_bytes().startswith(b"\x89PNG")
    numbers = json.loads(cli("account", path, "--json").out)
    assert numbers == {**run.account().numbers, "missing": []}


def test_a_shape_that_is_not_of_a_pair_is_answered_by_the_pairs(run):
    with pytest.raises(InputError, match=r"^nothing: is no pair; known: .*\("):
        run.pair_forces()["nothing"]


def test_a_body_rises_against_gravity():
    """1 kg, which 10 N push along -x, against 4 N of gravity: 6 N h^2 / m = 0.6 mm a step."""
    box = {"box": free(block(1.0, (0.1, 0.1, 0.1)), (0, 0, 1), (-10, 0, 0))}
    run = scene(box, {"floor": ("floor", "box", 0.5, 4)}, 5, gravity=[4, 0, 0]).run(progress=False)
    assert run.account().numbers["bodies"]["box"]["largest_rise_mm"] == pytest.approx(3.0)


def test_a_body_that_turns_on_has_turned_by_more_than_half_a_turn():
    """I = m a^2 / 6, so that a torque of 40 I / h^2 degrees turns it by 40 degrees a step."""
    torque = np.radians(40) * 0.1**2 / 6 / 0.01**2
    box = {"box": free(block(1.0, (0.1, 0.1, 0.1)), (0, 0, 1), torque=(0, torque, 0))}
    run = scene(box, {"floor": ("floor", "box", 0.5, 4)}, 10, gravity=[0, 0, 0]).run(progress=False)
    assert run.account().numbers["bodies"]["box"]["largest_rotation_deg"] == pytest.approx(400)
