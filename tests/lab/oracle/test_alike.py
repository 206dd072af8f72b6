"""What wrong parts of known scenes are like is said with its layer: they are like planted ones."""

import ast
import json
from functools import cache

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.oracle import alike
from quasistatic_ref.lab.oracle.alike import diagnosis, hash_of, known_name, likeness, planted
from quasistatic_ref.lab.oracle.comparison import DIGITS, comparison_of_run, diagnosis_of_runs
from quasistatic_ref.lab.oracle.parts import ENDED, Part, parts_of, way_of
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.vectors.check.patched import patched_texts, program, text_of_file
from quasistatic_ref.lab.vectors.check.table import PATCHES as PATCHES_OF
from tests.lab.oracle.test_compare import NAMES, SCENES, SIGN_OF_B, run_with
from tests.pages import flat
from validation.make.planted_runs import SCENES as KNOWN
from validation.make.planted_runs import first_step, moved, q_after, scene
from validation.make.program_changes import changes, changes_of_file

PRISMATIC = """mechanism.py:
- own[moving, 0] = pace * along
+ own[moving, 0] = pace * along * (3 if body["joint"] == "prismatic" else 1)"""
PATCHES = {
    "jacobian, the velocities of bodies": PRISMATIC,
    "integrate, q (+) delta_q": """integration.py:
- x = a * d[0] - b * d[2] * d[1]
+ x = a * d[0] + b * d[2] * d[1] / 2""",
    "rows, the table t of a cone": """rows.py:
- spins = [[0, 0, 1], [0, 0, -1]]
+ spins = [[0, 0, 3], [0, 0, -3]]""",
    "distance, the distance of a point to a solid": """curved.py:
- excess = np.array([r - R, abs(z) - half])
+ excess = np.array([r - R, abs(z) - 0.95 * half])""",
}
TIED = {
    "M in H": """step.py:
- M = M + mass * v.T @ v + w.T @ inertia @ w
+ M = M + mass * v.T @ v + 3 * w.T @ inertia @ w""",
    "loads and springs in g": """step.py:
- weight = weight + mass * v.T @ np.array(case["gravity"])
+ weight = weight + 0.7 * mass * v.T @ np.array(case["gravity"])""",
}


@cache
def parts_by(patch, name):
    _, _, result = first_step(name)
    return parts_of(scene(name).system, result, q_after(program(patch), name), DIGITS)


@pytest.mark.parametrize(("said", "patch"), PATCHES.items(), ids=PATCHES)
def test_a_mistake_that_was_not_planted_is_like_those_in_the_same_formula(said, patch):
    for file, text in patched_texts(patch).items():
        made = {ast.unparse(one) for one in ast.parse(text).body}
        assert made.isdisjoint(o.source for o in changes_of_file(file, text_of_file(file)))
    found = diagnosis({name: parts_by(patch, name) for name in NAMES})
    layer, _, formula = said.partition(", ")
    assert found.layer == layer
    assert formula in found.formulas


@pytest.mark.parametrize("patch", TIED.values(), ids=TIED)
def test_where_three_formulas_are_as_like_nothing_is_said(patch, monkeypatch):
    parts = {name: parts_by(patch, name) for name in NAMES}
    assert diagnosis(parts) is None
    monkeypatch.setattr(alike, "MOST", 3)
    assert diagnosis(parts).layer == "step"


def said_of(mistake):
    """What is said of a planted mistake by those that are known."""
    parts = {name: [] for name in NAMES}
    for name, (way, off) in mistake.wrong.items():
        scene_name, _, part = name.partition(": ")
        parts[scene_name].append(Part(part, way, off))
    names = {name for one in planted()[1] for name in one.wrong} - mistake.wrong.keys()
    for name in names:
        scene_name, _, part = name.partition(": ")
        parts[scene_name].append(Part(part, "", np.zeros(1)))
    return diagnosis(parts)


def test_planted_mistakes_are_known_by_those_of_other_lines(monkeypatch):
    scenes, every = planted()
    counts = {"asked": 0, "said": 0, "layer": 0, "formula": 0}
    for mistake in every[::4]:
        others = [one for one in every if one.place != mistake.place]
        if not any({*one.subjects} & {*mistake.subjects} for one in others):
            continue  # the only line that computes it
        monkeypatch.setattr(alike, "planted", lambda others=others: (scenes, others))
        found = said_of(mistake)
        monkeypatch.undo()
        counts["asked"] += 1
        if found is not None:
            counts["said"] += 1
            counts["layer"] += found.layer == mistake.layer
            counts["formula"] += not {*found.formulas}.isdisjoint(mistake.subjects)
    assert counts["asked"] > 80
    assert 0.5 * counts["asked"] <= counts["said"] < 0.8 * counts["asked"]
    assert counts["layer"] >= 0.7 * counts["said"]
    assert counts["formula"] >= 0.6 * counts["said"]


def test_the_file_is_what_the_program_makes():
    """But for offsets of 1e-17, which the kernel of BLAS decides: the likeness is 1."""
    files = ["rows.py", "step.py", "integration.py"]
    for change in changes():
        if change.file in files and (found := moved(change)):
            wrong = {name: (way, np.array(off)) for name, (way, off) in found.items()}
            assert max(likeness(wrong, one.wrong) for one in planted()[1]) > 1 - 1e-5, change.new
            files.remove(change.file)
        if not files:
            break
    assert not files


def test_it_is_said_with_the_layer_whatever_scenes_were_run(tmp_path, cli):
    given = []
    for name in "joints", "pushed":  # the second has no such joint
        path = str(SCENES / f"{name}.toml")
        run = run_with(tmp_path, path, PRISMATIC, 1).rename(tmp_path / f"{name}.csv")
        given += [path, str(run)]
    said = flat(cli("compare", *given, "--quiet", status=1).out)
    assert "pushed.toml: 1 steps, each as the reference takes it" in said
    assert "layer jacobian: the planted mistake that is most alike (likeness 0." in said
    assert "is a scene without a run" in cli("compare", *given[:3], status=2).err
    found = json.loads(cli("compare", *given, "--json", status=1).out)
    assert found["layer"] == "jacobian"
    assert "the velocities of bodies" in found["formulas"]
    assert "mechanism.py, line " in found["place"]
    assert 0.5 < found["likeness"] < 1


def test_of_a_program_that_ends_at_once_the_layer_is_open(tmp_path, cli):
    given = []
    for name, steps in (("free", 1), ("joints", 1), ("pushed", 0)):
        path = str(SCENES / f"{name}.toml")
        run = run_with(tmp_path, path, "", steps).rename(tmp_path / f"{name}.csv")
        given += [path, str(run)]
    found = json.loads(cli("compare", *given, "--json", status=1).out)
    assert [one["steps"] for one in found["runs"]] == [1, 1, 0]
    assert (found["layer"], found["formulas"]) == (None, None)  # many formulas end it
    said = flat(cli("compare", *given, "--quiet", status=1).out)
    assert said.endswith("the run has no step no planted mistake is like this: the layer is open")


def test_a_part_is_wrong_alone():
    scenario = scene("free")
    q = np.array([scenario.system.q_start, first_step("free")[2].q])
    names = [name for joint in scenario.system.joints for name in joint.positions]
    q[1, names.index("driven/slide [m]")] += 1e-3
    found = comparison_of_run(scenario, OtherRun(0, q, 0.0))
    assert [part.name for part in found.parts if part.way] == ["driven/slide"]
    assert len(found.parts) > 40
    right = np.array([scenario.system.q_start, first_step("free")[2].q])
    both = [found, comparison_of_run(scenario, OtherRun(0, right, 0.0))]
    alone = diagnosis_of_runs([found])
    assert alone is not None
    assert diagnosis_of_runs(both) == diagnosis_of_runs(both[::-1]) == alone
    later = comparison_of_run(scenario, OtherRun(1, q, 0.0))
    assert later.parts == ()  # it does not begin where the scene does


CHANGES = {
    "h": ([], {"h": 0.01}),
    "alpha": (['contacts.hinge.alpha="driven/slide"'], {}),
    "law": ([], {"law": "coulomb"}),
    "cone": ([], {"cone": "pyramid"}),
    "gravity": (["gravity=[0.4,-0.3,-9.6]"], {}),
}


@pytest.mark.parametrize(("changes", "settings"), CHANGES.values(), ids=CHANGES)
def test_a_scene_that_was_changed_is_none_of_the_known_ones(changes, settings):
    changed = qr.load_scenario(SCENES / "joints.toml", changes, **settings)
    assert known_name(changed) == ""
    q = np.array([changed.system.q_start, scene("joints").system.q_start])
    assert comparison_of_run(changed, OtherRun(0, q, 0.0)).parts == ()


def test_a_scene_is_known_by_its_data_and_not_by_its_file(tmp_path):
    assert [known_name(scene(name)) for name in KNOWN] == [*KNOWN]
    copy = tmp_path / "mine.toml"
    copy.write_text((SCENES / "pushed.toml").read_text("utf-8"), "utf-8")
    for file in SCENES.glob("*.urdf"):
        (tmp_path / file.name).write_text(file.read_text("utf-8"), "utf-8")
    assert known_name(qr.load_scenario(copy)) == "pushed"
    assert known_name(qr.load_scenario("sphere_spin")) == ""


def nudged(value, eps):
    if isinstance(value, dict):
        return {name: nudged(one, eps) for name, one in value.items()}
    if isinstance(value, list):
        return [nudged(one, eps) for one in value]
    return value * (1 + eps) + 1e-2 * eps if isinstance(value, float) else value


@pytest.mark.parametrize("name", KNOWN)
def test_last_bits_do_not_make_it_another_scene(name):
    case = first_step(name)[1]
    for eps in (-1e-15, 1e-15):
        assert hash_of(nudged(case, eps)) == planted()[0][name]
    assert hash_of(nudged(case, 1e-8)) != planted()[0][name]


def test_a_first_wrong_step_that_is_later_is_held_against_classic_mistakes(tmp_path, cli):
    name = "inertia not turned into the world"
    path = str(SCENES / "keys.toml")  # where it moves nothing before the second step
    run = run_with(tmp_path, path, PATCHES_OF[name]["step"][0], 2)
    said = flat(cli("compare", path, str(run), "--quiet", status=1).out)
    assert "step 1 (t = " in said
    assert f"looks like {name} (layer " in said
    assert "planted" not in said


def test_a_classic_mistake_that_is_named_is_not_denied(tmp_path, cli):
    given = []
    for name, path in (("other", "block_push"), ("pushed", str(SCENES / "pushed.toml"))):
        run = run_with(tmp_path, path, SIGN_OF_B, 2).rename(tmp_path / f"{name}.csv")
        given += [path, str(run)]
    said = flat(cli("compare", *given, "--quiet", status=1).out)
    assert "looks like sign of b (layer rows)" in said
    assert "the layer is open" not in said
    assert json.loads(cli("compare", *given, "--json", status=1).out)["layer"] == "rows"


@pytest.mark.parametrize("decimals", [5, 6])
def test_a_rounded_run_is_one_of_a_known_scene(decimals):
    scenario = scene("keys")
    q = np.array([scenario.system.q_start, first_step("keys")[2].q]).round(decimals)
    run = OtherRun(0, np.array([scenario.system.normalised(one) for one in q]), 10.0**-decimals)
    found = comparison_of_run(scenario, run)
    assert found.parts
    assert not found.wrong_parts


def test_a_start_with_the_other_sign_of_a_quaternion_is_the_same():
    scenario = scene("free")
    q = np.array([scenario.system.q_start, first_step("free")[2].q])
    names = [name for joint in scenario.system.joints for name in joint.positions]
    at = names.index("floating.qx [-]")
    q[0, at : at + 4] *= -1
    assert comparison_of_run(scenario, OtherRun(0, q, 0.0)).parts


def test_a_way_is_told_by_impulse_and_rows():
    J, A, b = np.array([[0.0, 1.0]]), np.array([[0.0, 1.0]]), np.array([0.0])
    H, g = np.eye(2), np.array([1.0, -1.0])
    ways = {
        "of contacts, at": [1.0, 0.0], "of contacts, above": [1.0, 0.5], "none, below": [1.0, -1.0],
        "another, at": [2.0, 0.0], "another, below": [2.0, -0.5],
    }  # fmt: skip
    for way, delta_q in ways.items():
        assert way_of(J, A, b, H, g, np.array(delta_q)) == way
    assert way_of(J[:0], A[:0], b[:0], H, g, g) == "free"


def test_likeness_is_of_parts_ways_and_offsets():
    one = {"a": ("none, at", np.array([1.0, 0.0])), "b": ("free", np.array([2.0]))}
    assert likeness(one, one) == 1
    assert likeness(one, {"c": one["a"]}) == 0
    assert likeness(one, {"a": one["a"]}) == 0.5
    other = {"a": ("none, above", np.array([0.0, 1.0])), "b": ("free", np.array([0.5]))}
    assert likeness(one, other) == pytest.approx((0.3 + 0.2 + 0.7 + 0.15) / 2)
    ended = {"a": (ENDED, np.zeros(2)), "b": (ENDED, np.zeros(1))}
    assert likeness(one, ended) == pytest.approx(0.15)
    assert likeness(ended, ended) == 1
