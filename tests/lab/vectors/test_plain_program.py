"""The program to copy from: complete, independent of the package, and right."""

import ast
import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.lab.program.candidates import candidates
from quasistatic_ref.lab.program.distance import closest_points
from quasistatic_ref.lab.program.step import contacts_of
from tests.cases import first
from tests.closeness import assert_within
from tests.lab.vectors.committed_cases import (
    NUMPY,
    VECTORS,
    inputs_of,
    plain_answer,
    record_of,
    report_on,
    verdict_of,
)
from tests.made import bits, text_written
from tests.pages import PACKAGE
from tests.processes import python
from tests.tolerances import CLOSED_FORM

PROGRAM = PACKAGE / "lab" / "program"
LIBRARIES = {"json", "numpy", "pathlib", "sys"}
FOUND = Path(__file__).with_name("found_by_challenges.json")
"""Quadratic programs that this one or another once got wrong: rows that all but repeat or
contradict each other, cones at their tips."""


def test_a_cone_that_the_plain_program_lacks_is_refused():
    with pytest.raises(ValueError, match="the cone pyramid-45 is none that this program knows"):
        plain_answer("rows", inputs_of("rows/random/3") | {"cone": "pyramid-45"})


@pytest.mark.parametrize("every", first(1, [3, 1]))
def test_the_plain_program_passes_layers_1_to_8(tmp_path, every):
    """A copy of it answers from its own folder; warnings are errors."""
    shutil.copytree(PROGRAM, tmp_path / "program")
    for layer in NUMPY:
        path = Path("vectors", "inputs", f"{layer}.json")
        inputs = json.loads((VECTORS / path.relative_to("vectors")).read_text())
        inputs["cases"] = inputs["cases"][::every]
        text_written(tmp_path / path, json.dumps(inputs))
    python("-W", "error", "-m", "program", "vectors", "answers", cwd=tmp_path)
    for layer in NUMPY:
        answers = json.loads((tmp_path / "answers" / f"{layer}.json").read_text())["answers"]
        report = report_on(layer, {each["id"]: each["output"] for each in answers})
        assert report.ok, report.trouble
        assert report.count("passed") > 0


def test_the_plain_program_takes_challenges(cli):
    program = f"'{sys.executable} -m quasistatic_ref.lab.program'"
    cli("vectors challenge --quiet --cases 8 --command", program)


def test_points_of_a_cloud_that_are_written_twice_are_one():
    corners = [[x, y, 0.0] for x in (-0.1, 0.1) for y in (-0.1, 0.1)]
    floor = {"kind": "halfspace", "normal": [0, 0, 1], "offset": 0}
    here = np.eye(3), np.zeros(3)
    once, twice = (
        candidates(floor, here, {"kind": "cloud", "points": points}, here, 4)
        for points in (corners, [*corners, *corners])
    )
    assert bits(twice) == bits(once)
    assert len(once[0]) == 4


def test_faults_of_programs_that_challenges_found_are_mended():
    for case in json.loads(FOUND.read_text()):
        verdict = verdict_of("qp", case, record_of("qp", case), plain_answer("qp", case))
        assert verdict.verdict != "failed", verdict


def test_boxes_that_touch_with_their_faces_are_not_apart():
    """Half of 0.06 m and, after a quarter turn, half of 0.1 m are 0.08 m along x.

    Differences of corners are on a grid: the point of least length needs none of some that Wolfe's
    method tries, but for rounding.
    """
    box = {"kind": "box", "size": [0.06, 0.1, 0.16]}
    turned = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    there = turned, np.array([-0.08, -0.03, 0.01])
    phi, *_ = closest_points(box, (np.eye(3), np.zeros(3)), box, there)
    assert_within(phi, 0, CLOSED_FORM)


def test_the_plain_program_shares_no_code_with_the_package():
    own = {path.stem for path in PROGRAM.glob("*.py")}
    for path in PROGRAM.glob("*.py"):
        for part in ast.walk(ast.parse(path.read_text())):
            if isinstance(part, ast.Import):
                assert {alias.name for alias in part.names} <= LIBRARIES
            elif isinstance(part, ast.ImportFrom):
                assert part.module in (own if part.level == 1 else LIBRARIES)


@pytest.mark.parametrize("other", ["convex", "box", "halfspace"])
def test_several_contacts_of_a_mesh_are_refused(other):
    pose = {"xyz": [0, 0, 0], "quaternion": [0, 0, 0, 1]}
    shapes = {
        name: {"body": None, "shape": {"kind": kind}, "pose": pose}
        for name, kind in (("mesh", "convex"), ("other", other))
    }
    pair = {"name": "p", "alpha": "mesh", "beta": "other", "k": 2}
    with pytest.raises(ValueError, match="ask for k = 1"):
        contacts_of({"shapes": shapes, "pairs": [pair]}, {None: (np.eye(3), np.zeros(3), None)})
