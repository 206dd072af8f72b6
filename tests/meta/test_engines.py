"""Phenomena for engines: committed results are those that reproductions and the page show."""

import json
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.challenge.program import Program
from validation.make.second_order import Engines
from validation.programs.engines import phenomena, second_order, second_order_page
from validation.programs.engines.judge import ENGINES, HERE, RESULTS
from validation.programs.engines.reproduce import FOLDER, LIST, cells_without_program, unlike
from validation.programs.engines.tables import phenomena_page

RECORDS = {name: json.loads((RESULTS / f"{name}.json").read_text("utf-8")) for name in ENGINES}
MUJOCO = sorted(e["file"] for e in LIST if e["engines"][0] == "mujoco" and e["phenomena"])
NUMBER = re.compile(r"\d[\d.]*(?:e[+-]\d+)?")


def test_the_engine_of_the_page_is_asked_everything(capsys):
    page = (RESULTS.parents[2] / "docs" / "engines.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    with np.errstate(divide="ignore", invalid="ignore"):  # its bodies never move
        exec(compile(code, "engines.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(phenomena.PHENOMENA)


def test_every_red_cell_is_shown_by_its_reproduction_in_its_setting():
    assert cells_without_program(RECORDS) == unlike(RECORDS) == []


def test_the_page_is_that_of_the_results():
    assert (RESULTS / "phenomena.md").read_text("utf-8") == phenomena_page(RECORDS)


@pytest.mark.parametrize("file", MUJOCO)
def test_a_reproduction_of_mujoco_prints_what_is_committed(file):
    command = [sys.executable, str(FOLDER / file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    found = done.stdout.rstrip()
    committed = RECORDS["mujoco"]["printed"][file]
    assert NUMBER.sub("", found) == NUMBER.sub("", committed)
    if f"mujoco=={version('mujoco')}" in ENGINES["mujoco"]["requires"]:  # another's digits differ
        assert found == committed


@pytest.mark.parametrize("scene", second_order.STUDY["scene"])
def test_a_run_of_the_study_of_second_order_simulators_is_the_committed_one(scene):
    # One engine's own run, and the reference of the scene without a closed form.
    engine = "mujoco"
    setting = "implicitfast, elliptic, impratio 100, solref 5 ms"
    h = 0.002
    run = second_order.Run(scene, 0.3, engine, setting, h)
    engines = Engines(Path(sys.prefix))
    engines.programs[engine] = Program(f"{sys.executable} {HERE / 'mujoco_adapter.py'}", 60.0)
    with engines.programs[engine]:
        found = engines.row(run)
    (committed,) = second_order_page.rows_with(**run._asdict())
    assert found | {"cost": 0.0} == committed | {"cost": 0.0}
