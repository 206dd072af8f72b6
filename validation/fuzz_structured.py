"""Fuzzing by structure: good steps, scenarios and URDFs with a few of their values replaced.

Hypothesis draws which and by what, and shrinks what it finds. Whatever is drawn is refused by a
sentence, or gives an answer that is finite and certified; warnings count as failures.

    python -m validation.fuzz_structured --seconds 60
"""

from __future__ import annotations

import argparse
import copy
import json
import re
import sys
import time
import tomllib
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from quasistatic_ref.errors import InputError, QuasistaticError, RunFailed
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.resources import models_folder
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.files import step_read
from validation.fuzz_seeds import scratch, step_text

SLOWEST = 10.0
"""No input may take longer [s]."""
EXAMPLES = 100
NUMBERS = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.sampled_from([0.0, -0.0, 5e-324, 1e-160, 1e-12, 1.0, -1.0, 1e12, 1e160, 1.7e308]),
    st.integers(-3, 3),
    st.integers(-(10**400), 10**400),
)
VALUES = st.recursive(
    st.one_of(NUMBERS, st.booleans(), st.text(max_size=4), st.none()),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=4), inner, max_size=3)
    ),
    max_leaves=6,
)
SCENE = """
format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 2
gravity = [0, 0, -9.81]
cone = "pyramid"
record = "full"
solver = { backend = "clarabel", accuracy = 1e-12, certify = "full" }
limits = { penetration = 0.05, reach = 10 }
[bodies.gripper]
urdf = "gripper.urdf"
base = "floating"
actuated = ["base", "width"]
K_q = { base = [800, 800, 800, 20, 20, 20], width = 2000 }
pose = { xyz = [0, 0, 0.2], rpy = [0, 0, 0.1] }
positions = { width = 0.06 }
gravity_compensated = false
[[bodies.gripper.targets]]
t = 0.0
width = 0.06
base = { xyz = [0, 0, 0.2], rpy = [0, 0, 0.1] }
[[bodies.gripper.targets]]
t = 0.5
width = 0.05
base = { xyz = [0, 0, 0.3], rpy = [0, 0.1, 0] }
[bodies.ball]
urdf = "sphere.urdf"
base = "floating"
cloud = "cloud.xyz"
pose = { xyz = [0, 0, 0.05] }
[[bodies.ball.wrenches]]
t = 0.0
force = [0, 0, 0]
torque = [0, 0, 0.01]
[shapes.floor]
halfspace = { normal = [0, 0, 1], offset = 0 }
[shapes.post]
capsule = { radius = 0.1, length = 1 }
pose = { xyz = [2, 0, 0], rpy = [1, 0, 0] }
[shapes.block]
box = { size = [0.1, 0.2, 0.3] }
pose = { xyz = [-2, 0, 0] }
[shapes.pillar]
cylinder = { radius = 0.1, length = 1 }
pose = { xyz = [0, 2, 0] }
[contacts.floor]
alpha = "floor"
beta = "ball"
mu_v = 0.5
mu_omega = 0.01
rows = 6
k = 2
[contacts.around]
alpha = ["post", "block", "pillar", "gripper/left_finger"]
beta = "ball"
mu_v = 0.6
rows = 4
k = 1
"""
Path_ = tuple[Any, ...]


def places(value: Any, above: Path_ = ()) -> Iterator[Path_]:
    """Where a value can be replaced in a record."""
    if above:
        yield above
    if isinstance(value, dict | list):
        inner = value.items() if isinstance(value, dict) else enumerate(value)
        for key, one in inner:
            yield from places(one, (*above, key))


def replaced(record: Any, changes: list[tuple[Path_, Any]]) -> Any:
    """A copy of a record with values replaced; a place that is gone is left out."""
    record = copy.deepcopy(record)
    for path, value in changes:
        at = record
        try:
            for key in path[:-1]:
                at = at[key]
            at[path[-1]] = value
        except (KeyError, IndexError, TypeError):
            continue
    return record


def changes_of(record: Any, values: st.SearchStrategy[Any] = VALUES) -> st.SearchStrategy[Any]:
    """One to three replacements, half of them of a number by a number."""
    everywhere = list(places(record))
    kinds = st.sampled_from(everywhere)
    return st.lists(st.tuples(kinds, st.one_of(NUMBERS, values)), min_size=1, max_size=3)


def toml_text(value: Any) -> str:
    """A value as inline TOML."""
    if isinstance(value, dict):
        pairs = ", ".join(f"{json.dumps(k)} = {toml_text(v)}" for k, v in value.items())
        return f"{{{pairs}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml_text, value))}]"
    if isinstance(value, str | bool) or value is None:
        return json.dumps(value)
    return str(value)


def refused(error: QuasistaticError) -> bool:
    """False, for "not accepted"; the sentence must be one."""
    sentence = str(error)
    assert sentence
    assert "\n" not in sentence
    return False


def step_target(folder: Path) -> tuple[st.SearchStrategy[Any], Callable[[Any], bool]]:
    """Step files: read, solved, certified."""
    record: dict[str, Any] = json.loads(step_text())

    def run(changes: Any) -> bool:
        path = folder / "step.json"
        path.write_text(json.dumps(replaced(record, changes)))
        try:
            solution = solve_step(step_read(path))
        except QuasistaticError as refusal:
            return refused(refusal)
        assert np.isfinite(solution.delta_q).all()
        assert np.isfinite(solution.lam).all()
        assert solution.certificate.kind == "exact"
        return True

    return changes_of(record), run


def scenario_target(folder: Path) -> tuple[st.SearchStrategy[Any], Callable[[Any], bool]]:
    """Scenario files: loaded, and run for at most two steps."""
    record = tomllib.loads(SCENE)
    for model, file in (("sphere_spin", "sphere.urdf"), ("bunny_grasp", "gripper.urdf")):
        (folder / file).write_bytes((models_folder() / model / file).read_bytes())
    (folder / "cloud.xyz").write_text("0 0 0.05\n0 0 -0.05\n")

    def run(changes: Any) -> bool:
        path = folder / "scene.toml"
        fields = replaced(record, changes).items()
        path.write_text("".join(f"{key} = {toml_text(value)}\n" for key, value in fields))
        try:
            scenario = load_scenario(path)
            if scenario.steps > 2:
                return True
            trajectory = scenario.run(progress=False)
        except (InputError, RunFailed) as refusal:
            return refused(refusal)
        assert np.isfinite(trajectory["q"]).all()
        return True

    return changes_of(record), run


def urdf_target(folder: Path) -> tuple[st.SearchStrategy[Any], Callable[[Any], bool]]:
    """URDF files: attributes replaced by numbers and words, elements repeated or left out."""
    good = (models_folder() / "bunny_grasp" / "gripper.urdf").read_text()
    attributes = [match.span(1) for match in re.finditer(r'"([^"]*)"', good)]
    elements = [match.span() for match in re.finditer(r"<[^>]*>", good)]
    known = [good[a:b] for a, b in elements]
    value = st.one_of(NUMBERS.map(str), st.text("0123456789.eE+-naif ", max_size=12))
    one = st.one_of(
        st.tuples(st.sampled_from(attributes), value),
        st.tuples(st.sampled_from(attributes), st.tuples(NUMBERS, NUMBERS, NUMBERS).map(
            lambda three: " ".join(map(str, three))
        )),
        st.tuples(st.sampled_from(elements), st.sampled_from(["", *known])),
    )  # fmt: skip

    def run(changes: Any) -> bool:
        text = good
        for (a, b), new in sorted(changes, reverse=True):
            text = text[:a] + new + text[b:]
        path = folder / "robot.urdf"
        path.write_text(text)
        try:
            system = System([Body("r", path, "floating")])
        except InputError as refusal:
            return refused(refusal)
        assert np.isfinite(system.M_u(system.q_start)).all()
        assert np.isfinite(system.kinematics(system.q_start).J).all()
        return True

    return st.lists(one, min_size=1, max_size=3), run


TARGETS = {"step": step_target, "scenario": scenario_target, "urdf": urdf_target}


def fuzzed(name: str, seconds: float, folder: Path) -> dict[str, Any]:
    """Fuzz one target for some time; what was run, and what was found."""
    strategy, run = TARGETS[name](folder)
    counts = {"inputs": 0, "accepted": 0}
    found: dict[str, str] = {}
    slowest, end, number = 0.0, time.monotonic() + seconds, 0

    def one(changes: Any) -> None:
        nonlocal slowest
        if time.monotonic() > end:
            return
        start = time.perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            accepted = run(changes)
        slowest = max(slowest, time.perf_counter() - start)
        assert time.perf_counter() - start < SLOWEST
        counts["inputs"] += 1
        counts["accepted"] += accepted

    while time.monotonic() < end:
        test = settings(
            max_examples=EXAMPLES, deadline=None, database=None, print_blob=False,
            report_multiple_bugs=False,
            suppress_health_check=list(HealthCheck), phases=(Phase.generate, Phase.shrink),
        )(seed(number)(given(strategy)(one)))  # fmt: skip
        number += 1
        try:
            test()
        except Exception as error:  # every kind is a finding
            where = error.__traceback__
            while where is not None and where.tb_next is not None:
                where = where.tb_next
            line = "" if where is None else f"{Path(where.tb_frame.f_code.co_filename).name}"
            key = f"{type(error).__name__} in {line}: {str(error).splitlines()[:1]}"
            notes = " ".join(getattr(error, "__notes__", []))
            found.setdefault(key, " ".join(notes.split()))
    return {"target": name, **counts, "slowest [s]": round(slowest, 2), "found": found}


def main() -> int:
    """Fuzz each target in turn, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="in all")
    parser.add_argument("--target", choices=sorted(TARGETS), action="append")
    options = parser.parse_args()
    names = options.target or list(TARGETS)
    failures = 0
    for name in names:
        with scratch() as folder:
            report = fuzzed(name, options.seconds / len(names), Path(folder))
        failures += len(report["found"])
        print(json.dumps(report, indent=1))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
