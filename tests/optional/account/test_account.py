"""The account of a run: every number of it equals one computed from the npz, in plain loops."""

import json
from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import InputError, Trajectory, load_scenario, trajectory_read
from quasistatic_ref.optional.account.spans import spans
from quasistatic_ref.optional.account.words import events, lines, slid, tables
from quasistatic_ref.simulate.account import Span
from quasistatic_ref.tolerances import BRIEF, CARRIES, NEAR, SLID, SLIDES, TOUCHES
from tests.closeness import assert_relative
from tests.tolerances import ROUNDING

RUNS = {"block_push": 150, "bunny_grasp": 110, "door": 120, "two_finger_pinch": 40}


@pytest.fixture(scope="module", params=RUNS)
def run(request, tmp_path_factory):
    """A run from its file, which holds forces."""
    scenario = load_scenario(request.param, steps=RUNS[request.param], fast=True, record="forces")
    path = scenario.run(progress=False).save(tmp_path_factory.mktemp("run") / "run.npz")
    return trajectory_read(path)


def coefficients(run, own):
    """mu_v twice and mu_omega, which contacts without torsion do not use."""
    for j in own:
        yield run["mu_v"][j], run["mu_v"][j], run["mu_omega"][j] * (run["rows"][j] == 6)


def lasting_times(of_steps, t):
    """First and last times of what holds, changes of BRIEF steps left out, step by step."""
    found = []
    for k, holds in enumerate(of_steps):
        if holds and found and k - found[-1][1] <= BRIEF + 1:
            found[-1][1] = k
        elif holds:
            found.append([k, k])
    last = len(of_steps) - 1
    long = [s for s in found if s[1] - s[0] >= BRIEF or s[0] == 0 or s[1] == last]
    return [[t[a], t[b]] for a, b in long]


def contact(run, k, j):
    """Gap after step k of contact j, its slip, and the least of the pyramid's rows, Eq. (4)."""
    motion = run["motion"][k, j]
    gap = run["phi"][k, j] + run["n"][k, j] @ motion[:3]
    slips = [run[axis][k, j] @ motion[:3] for axis in ("d1", "d2")]
    mu_v = run["mu_v"][j]
    spin = abs(run["mu_omega"][j] * motion[3]) if run["rows"][j] == 6 else 0.0
    least = gap - max(mu_v * abs(slips[0]), mu_v * abs(slips[1]), spin)
    return np.hypot(*slips), least


def test_numbers_of_pairs_are_those_of_the_arrays(run):
    said = tables(run.account())["pairs"]
    t = run["t"].tolist()
    slots = [slot.rpartition("/")[0] for slot in run.header["slots"]]
    assert list(said) == list(dict.fromkeys(slots))
    for name, numbers in said.items():
        own = [j for j, slot in enumerate(slots) if slot == name]
        slip = []
        touches = []
        for k in range(run.steps):
            rows = [contact(run, k, j) for j in own]
            on = [moved for moved, least in rows if least <= TOUCHES]
            touches.append(bool(on))
            slip.append(sum(on) / len(on) if on else 0.0)
        assert numbers["least_distance_m"] == run["phi"][:, own].min()
        assert numbers["near_s"] == lasting_times(run["phi"][:, own].min(axis=1) <= NEAR, t)
        assert numbers["touches_s"] == lasting_times(touches, t)
        assert numbers["slides_s"] == lasting_times(np.array(slip) > SLIDES * run.header["h"], t)
        np.testing.assert_allclose(numbers["slip_m"], sum(slip), rtol=ROUNDING, atol=1e-15)
        f = run["forces"][:, own]
        tangential = [[np.hypot(*f[k, i, :2]) for i in range(len(own))] for k in range(run.steps)]
        friction = [sum(each) for each in tangential]
        normal = [f[k, :, 2].sum() for k in range(run.steps)]
        assert run.header["cone"] == "pyramid"
        needs = [
            sum(
                sum(abs(part) / mu for part, mu in zip(f[k, i, [0, 1, 3]], mus, strict=True) if mu)
                for i, mus in enumerate(coefficients(run, own))
            )
            for k in range(run.steps)
        ]
        share = [need / most if most > 0 else 0 for need, most in zip(needs, normal, strict=True)]
        torque = [np.abs(f[k, :, 3]).sum() for k in range(run.steps)]
        expected = {
            "normal_N": max(normal),
            "friction_N": max(friction),
            "torque_Nm": max(torque),
            "share": max(share),
        }
        for key, value in expected.items():
            np.testing.assert_allclose(numbers[f"largest_{key}"], value, rtol=1e-12, atol=1e-15)


def test_numbers_of_bodies_and_joints_are_those_of_the_arrays(run):
    said = tables(run.account())
    names = run.header["positions"]
    for name, numbers in said["bodies"].items():
        if name.endswith("/base"):
            first = names.index(f"{name.removesuffix('/base')}.x [m]")
            q = run["q"][:, first : first + 7]
            np.testing.assert_array_equal(numbers["moved_m"], q[-1, :3] - q[0, :3])
            assert numbers["largest_rise_mm"] == 1e3 * (q[:, 2] - q[0, 2]).max()
            # The angle between two quaternions: 2 acos |a . b|, which is good to 1e-7 near 0.
            cosine = np.abs(q[:, 3:] @ q[0, 3:]).clip(0, 1)
            angle = np.degrees(2 * np.arccos(cosine)).max()
            assert abs(numbers["largest_rotation_deg"] - angle) <= 1e-5
        else:
            value = run["q"][:, names.index(f"{name} [rad]")]
            angle = np.degrees(np.abs(value - value[0]).max())
            assert_relative(numbers["largest_rotation_deg"], angle, ROUNDING)
    stiffness = run.header["scene"]["stiffness"]
    for name, numbers in said["joints"].items():
        if not name.endswith("/base"):
            i = names.index(f"{name} [m]")
            error = np.abs(run["q"][1:, i] - run["q_bar_a"][:, i])
            assert numbers["ends_from_target_m"] == error[-1]
            K_q = stiffness[run.header["coordinates"].index(name)]
            assert_relative(numbers["largest_spring"], K_q * error.max(), ROUNDING)
    assert said["findings"] == [str(finding) for finding in run.findings]


def test_what_carries_a_body_lifts_it_by_a_tenth_at_least(run):
    """Gravity is along -z in these scenes; the force on beta is f_d1 d1 + f_d2 d2 + f_n n."""
    said = tables(run.account())["bodies"]
    slots = [slot.rpartition("/")[0] for slot in run.header["slots"]]
    for name, numbers in said.items():
        body = name.partition("/")[0]
        lifted = {}
        for pair, alpha, beta in run.header["scene"]["pairs"]:
            for own, other, sign in ((alpha, beta, -1), (beta, alpha, 1)):
                if own.partition("/")[0] != body or other.partition("/")[0] == body:
                    continue
                own_slots = [j for j, slot in enumerate(slots) if slot == pair]
                z = [sum(sign * run["forces"][k, j, i] * run[axis][k, j, 2]
                         for j in own_slots for i, axis in enumerate(("d1", "d2", "n")))
                     for k in range(run.steps)]  # fmt: skip
                lifted[other] = lifted.get(other, 0) + np.maximum(z, 0)
        whole = sum(lifted.values())
        carries = {who: lasting_times((up > 0) & (up >= CARRIES * whole), run["t"].tolist())
                   for who, up in lifted.items()}  # fmt: skip
        assert numbers["carried_s"] == {who: when for who, when in carries.items() if when}


def test_events_are_the_changes_of_the_pairs(run):
    """One for each span of contact that begins or ends inside of the run, if no two are joined."""
    account = run.account()
    said = events(account)
    assert [e.t for e in said] == sorted(e.t for e in said)
    for pair in account.pairs:
        for span in pair.contact:
            if span.first:
                assert any(e.t <= run["t"][span.first] and "touch" in e.words for e in said)
            if span.last < run.steps - 1:
                assert any(e.t <= run["t"][span.last + 1] and " go of " in e.words for e in said)
        slides = [e for e in said if f"{pair.beta} slides" in e.words and pair.alpha in e.words]
        assert len(slides) == sum(slid(pair, span) >= SLID for span in pair.sliding)


def test_a_full_record_gives_the_account_of_a_record_of_forces(run, request):
    name = request.node.callspec.params["run"]
    full = load_scenario(name, steps=RUNS[name], fast=True).run(progress=False)
    of_both = [tables(x.account()) for x in (full, run)]
    pairs = [{key: (n["touches_s"], n["slides_s"]) for key, n in x.pop("pairs").items()}
             for x in of_both]  # fmt: skip
    assert pairs[0] == pairs[1]
    for one in of_both:
        one.pop("findings")  # of imbalance, which a full record does not hold
    assert of_both[0] == of_both[1]
    bare = {name: array for name, array in full.arrays.items() if name != "forces"}
    assert replace(full, arrays=bare).account(forces=False).pairs[0].loads is None


def test_a_light_record_says_what_is_missing():
    light = load_scenario("block_push", steps=60, fast=True, record="light").run(progress=False)
    account = light.account()
    assert all(pair.loads is None and pair.slip is None for pair in account.pairs)
    said = list(lines(account))
    assert "missing: a light record holds no forces: run again with record = 'forces'" in said
    assert any(line.startswith("missing: a light record has no slips") for line in said)


def test_a_file_from_before_there_were_accounts_is_refused(run):
    old = Trajectory({k: v for k, v in run.header.items() if k != "scene"}, run.arrays)
    with pytest.raises(InputError, match=r"^scene: has no scene: .* run it again"):
        old.account()
    hostile = Trajectory({**run.header, "scene": {"pairs": 3}}, run.arrays)
    with pytest.raises(InputError, match=r"scene\.waypoints"):
        hostile.account()


def test_a_brief_change_is_none():
    held_from = np.zeros(30, dtype=bool)
    held_from[5:12] = True
    held_from[12 + BRIEF :] = True  # a gap of BRIEF steps
    assert spans(held_from) == [Span(5, 29)]
    held_from[12 + BRIEF] = False
    assert spans(held_from) == [Span(5, 11), Span(13 + BRIEF, 29)]
    one = np.zeros(30, dtype=bool)
    one[7 : 7 + BRIEF] = True
    assert spans(one) == []
    one[7 + BRIEF] = True
    assert spans(one) == [Span(7, 7 + BRIEF)]


def test_the_command_writes_text_json_a_page_and_a_figure(tmp_path, cli):
    short = cli("run", "block_push", "--fast", "--set", "steps=60", "--out", tmp_path).out
    path = tmp_path / "block_push.npz"
    html = tmp_path / "page.html"
    png = tmp_path / "figure.png"
    whole = cli("account", path, "--figure", png, "--html", html).out
    x = trajectory_read(path)["q"][:, 1]  # of the block, which does not turn
    event = f"0.40 s block slides {1e3 * (x[-1] - x[39]):.3g} mm along floor to the end"
    assert event in short
    assert event in whole
    assert event in html.read_text("utf-8")
    assert png.read_bytes().startswith(b"\x89PNG")
    assert json.loads(cli("account", path, "--json").out) == tables(trajectory_read(path).account())


def test_a_shape_that_is_not_of_a_pair_is_answered_by_the_pairs(run):
    with pytest.raises(InputError, match=r"^nothing: is no pair; known: .*\("):
        run.pair_forces()["nothing"]
