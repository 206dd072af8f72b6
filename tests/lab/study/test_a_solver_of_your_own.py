"""The page for authors of solvers: its files and commands, alone in an empty folder."""

import importlib
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pandas
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.page import table_of
from quasistatic_ref.lab.study.solvers import function_solver
from quasistatic_ref.lab.study.store import rows_read
from tests.lab.study.asked import Limits, study
from tests.pages import EXAMPLES, ROOT, named_files, shell_lines
from tests.processes import python

PAGE = (ROOT / "docs" / "studies.md").read_text("utf-8")
FILES = named_files(PAGE)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, with the files of the page."""
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text, "utf-8")
    return tmp_path


@pytest.mark.long
def test_a_function_runs_in_a_study_of_ten_problems(folder, cli, capsys):
    script, report = shell_lines(PAGE)
    paths = os.environ | {"PYTHONPATH": str(ROOT)}
    python(*shlex.split(script)[1:], cwd=folder, env=paths)
    cli(report.removeprefix("quasistatic-ref "))
    rows = pandas.read_parquet("study/rows.parquet")
    assert rows.groupby("solver").size().to_dict() == {"clarabel": 10, "daqp": 10, "solve": 10}
    nnls = rows[rows.solver == "solve"]
    assert (nnls[nnls.feasible].digits > 9).all()
    assert set(nnls[~nnls.feasible].says) == {"infeasible"}
    assert "function:solve" in Path("report/summary.md").read_text("utf-8")
    exec(FILES["rows.py"], {})  # how the page asks the rows
    assert "contacts/" in capsys.readouterr().out


@pytest.mark.extra("compiled")  # a C compiler
def test_a_program_in_c_runs_in_a_study(folder, monkeypatch):
    for name in ("hildreth.c", "hildreth.py"):
        shutil.copy(EXAMPLES / name, folder)
    lines = Path("hildreth.py").read_text("utf-8").splitlines()
    (command,) = (line.removeprefix("First: ") for line in lines if "cc -O2" in line)
    subprocess.run([*shlex.split(command), "-Wall"], check=True)
    monkeypatch.syspath_prepend(str(folder))
    solve = importlib.import_module("hildreth").solve
    families = {"contacts": 2, "gaps": 2, "infeasible": 1}
    study(families, [solve], limits=Limits(time_limit=20.0))
    rows = pandas.read_parquet("study/rows.parquet")
    solved = rows[rows.feasible & (rows.says == "solved")]
    assert len(solved) >= 2
    assert (solved.digits > 9).all()


LACKING = {
    "pyarrow": lambda: rows_read("study"),
    "pandas": lambda: table_of([]),
    "cloudpickle": lambda: function_solver(print),
}


@pytest.mark.parametrize("package", LACKING)
def test_the_page_names_the_remedy_of_a_package_that_is_missing(package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=f"needs {package}: ") as refused:
        LACKING[package]()
    _, remedy = str(refused.value).split(": ")
    assert f"`{remedy}`" in PAGE
