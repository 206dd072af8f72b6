"""A set as qpbenchmark reads it, and its command."""

import csv
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from quasistatic_ref.lab.study.problems import exports


@pytest.mark.long  # the module alone sees wrong answers below
def test_qpbenchmark_runs_the_set_and_its_module_grades_by_exact_answers(
    tmp_path, monkeypatch, capsys, cli
):
    some = "--families condition,infeasible,capped_wedge --every 15 --out"
    said = cli("study problems export --units natural", some, tmp_path).err
    assert "left out 4 problems" in said
    program = Path(sys.executable).with_name("qpbenchmark")
    module = "contact_qp_natural.py"
    done = subprocess.run(
        [program, "--results-path", "results.csv", module, "run", "--solver", "daqp",
         "--author", "nobody"],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (tmp_path / "results.csv").open() as file:
        assert len({row["problem"] for row in csv.DictReader(file)}) == 10
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [module, "daqp"])
    runpy.run_path(module, run_name="__main__")
    digits = re.match(r"daqp: median ([\d.]+) digits", capsys.readouterr().out)
    assert float(digits[1]) > 10  # of the module's x: every sign is right


@pytest.mark.parametrize("part", ["x", "z"])
def test_the_module_of_qpbenchmark_sees_wrong_answers(tmp_path, members, part):
    one = next(one for one in members if one.facts["family"] == "contacts").natural
    exports.exported_files("contact-qp", [one], tmp_path)
    module = runpy.run_path(str(tmp_path / "contact_qp.py"))
    ((problem),) = module["ContactQp"]()
    answer = {"x": one.answer.x, "z": one.answer.lam}
    assert module["excess"](problem, **answer) < 1e-9
    assert module["excess"](problem, **{**answer, part: answer[part] + 1.0}) > 1e-3
