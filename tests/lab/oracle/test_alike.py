"""What wrong parts of known scenes are like is said with its layer: planted mistakes know them."""

import ast
import json
from functools import cache

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.oracle import alike
from quasistatic_ref.lab.oracle.alike import diagnosis, likeness, planted
from quasistatic_ref.lab.oracle.comparison import DIGITS, comparison_of_run, diagnosis_of_runs
from quasistatic_ref.lab.oracle.parts import ENDED, Part, parts_of, way_of
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.vectors.check.patched import patched_texts, program, text_of_file
from tests.lab.oracle.test_compare import NAMES, SCENES, run_with, table
from tests.quoted import flat
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
    "step, M in H": """step.py:
- M = M + mass * v.T @ v + w.T @ inertia @ w
+ M = M + mass * v.T @ v + 3 * w.T @ inertia @ w""",
    "step, loads and springs in g": """step.py:
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
    counts = {"asked": 0, "layer": 0, "formula": 0}
    for mistake in every[::4]:
        others = [one for one in every if one.place != mistake.place]
        if not any({*one.subjects} & {*mistake.subjects} for one in others):
            continue  # the only line that computes it
        monkeypatch.setattr(alike, "planted", lambda others=others: (scenes, others))
        found = said_of(mistake)
        monkeypatch.undo()
        counts["asked"] += 1
        if found is not None:
            counts["layer"] += found.layer == mistake.layer
            counts["formula"] += not {*found.formulas}.isdisjoint(mistake.subjects)
    assert counts["asked"] > 80
    assert counts["layer"] >= 0.5 * counts["asked"]
    assert counts["formula"] >= 0.33 * counts["asked"]  # of 30: by chance, one in fifteen


def test_the_file_is_what_the_program_makes():
    kept = [
        {name: [way, off.tolist()] for name, (way, off) in one.wrong.items()}
        for one in planted()[1]
    ]
    found = [moved(one) for one in changes() if one.file == "rows.py"][:4]
    assert any(found)
    assert all(one in kept for one in found if one)


def test_it_is_said_with_the_layer_whatever_scenes_were_run(tmp_path, cli):
    given = []
    for name in "joints", "pushed":  # the second has no such joint
        path = str(SCENES / f"{name}.toml")
        run = run_with(tmp_path, path, PRISMATIC, 1).rename(tmp_path / f"{name}.csv")
        given += [path, str(run)]
    said = flat(cli("compare", *given, "--quiet", status=1).out)
    assert "pushed.toml: 1 steps, each as the reference takes it" in said
    assert "layer jacobian: the most alike planted mistake (likeness 0." in said
    assert "is a scene without a run" in cli("compare", *given[:3], status=2).err
    found = json.loads(cli("compare", *given, "--json", status=1).out)
    assert found["layer"] == "jacobian"
    assert "the velocities of bodies" in found["formulas"]


def test_a_program_that_ends_at_once_is_told_in_words_and_by_what_the_scene_has(tmp_path, cli):
    given = []
    for name, steps in (("free", 1), ("joints", 1), ("pushed", 0)):
        path = str(SCENES / f"{name}.toml")
        run = run_with(tmp_path, path, "", steps).rename(tmp_path / f"{name}.csv")
        given += [path, str(run)]
    found = json.loads(cli("compare", *given, "--json", status=1).out)
    assert [one["steps"] for one in found["runs"]] == [1, 1, 0]
    assert found["layer"] in ("distance", "step", "rows")  # not one that the others need
    said = flat(cli("compare", *given, "--quiet", status=1).out)
    assert "the run has no step: its program ends before the first one" in said


def test_where_no_mistake_is_like_it_the_layer_is_open(tmp_path, cli):
    path = str(SCENES / "free.toml")
    scenario = qr.load_scenario(path, steps=2)
    q = scenario.run(progress=False).q
    off = np.full(scenario.system.n_v, 1e-3)
    run = table(tmp_path / "run.csv", scenario, [*q[:2], scenario.system.integrate(q[2], off)])
    said = flat(cli("compare", path, str(run), "--quiet", status=1).out)
    assert "no planted mistake is like this: the layer is open" in said


def test_a_part_is_wrong_alone():
    scenario = scene("free")
    q = np.array([scenario.system.q_start, first_step("free")[2].q])
    names = [name for joint in scenario.system.joints for name in joint.positions]
    q[1, names.index("driven/slide [m]")] += 1e-3
    found = comparison_of_run(scenario, OtherRun(0, q, 0.0))
    assert [part.name for part in found.parts if part.way] == ["driven/slide"]
    assert len(found.parts) > 40
    assert diagnosis_of_runs([comparison_of_run(scenario, OtherRun(0, q[:1], 0.0))]) is not None
    later = comparison_of_run(scenario, OtherRun(1, q, 0.0))
    assert later.parts == ()  # it does not begin where the scene does


def test_a_scene_that_was_changed_is_none_of_the_known_ones():
    assert alike.is_known(scene("pushed"))
    assert not alike.is_known(qr.load_scenario(SCENES / "pushed.toml", h=0.02))
    assert not alike.is_known(qr.load_scenario("sphere_spin"))


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
