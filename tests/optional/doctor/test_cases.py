"""Scenes of statics: each number by hand, and nothing else is said (cases/*.toml)."""

import copy
import tomllib
from pathlib import Path

import pytest

from quasistatic_ref import Body, Box, Sphere, load_scenario

HERE = Path(__file__).with_name("cases")
CASES = [
    pytest.param(case, id=case["what"], marks=pytest.mark.long if "long" in case else ())
    for file in sorted(HERE.glob("*.toml"))
    for case in tomllib.loads(file.read_text("utf-8"))["case"]
]


def scene_of(case, **more):
    """The scenario of a case, whose simple bodies are made here."""
    table = copy.deepcopy(case["scene"]) | {"fast": True} | more
    for body in table["bodies"].values():
        kind, *numbers = body["urdf"].split()
        sizes = [float(x) for x in numbers]
        if numbers:
            shape = Box(size=sizes[:-1]) if kind == "box" else Sphere(*sizes[:-1])
            body["urdf"] = Body.of_shape("solid", shape, sizes[-1]).urdf
        else:
            body["urdf"] = str(HERE / kind)
    return load_scenario(table)


@pytest.mark.parametrize("case", CASES)
def test_what_is_said_of_statics_is_right_by_hand(case):
    said = {one.name: one for one in scene_of(case).run(progress=False).findings}
    said.pop("uncertain-forces", None)
    assert said.keys() == case["hand"].keys()
    for name, numbers in case["hand"].items():
        for key, value in numbers.items():
            if isinstance(value, str):  # words of the cause, or of the remedy
                assert value in getattr(said[name], key)
            else:
                number, off = value
                right = pytest.approx(number, rel=off, abs=0.0 if number else off)
                assert abs(said[name].numbers[key]) == right


@pytest.mark.parametrize("backend", ["clarabel", "osqp", "none"])
@pytest.mark.parametrize("what", ["a rod slips", "a cube that a finger pushes at 0.1"])
def test_findings_do_not_depend_on_the_backend(what, backend):
    """Contacts share loads in many ways, and backends differ in theirs."""
    (case,) = [each.values[0] for each in CASES if each.values[0]["what"].startswith(what)]
    run = scene_of(case).run(progress=False)
    other = scene_of(case, fast=False, solver={"backend": backend}).run(progress=False)
    assert other.header.not_looked_at == run.header.not_looked_at == ""
    said = {one.name: one for one in other.findings}
    assert said.keys() == case["hand"].keys()
    for one in run.findings:
        assert said[one.name].numbers == pytest.approx(one.numbers, rel=1e-6, abs=1e-6)
