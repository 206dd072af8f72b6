"""The page for authors of solvers: its files and commands, alone in an empty folder."""

import shlex
import shutil
import subprocess
from pathlib import Path

import pandas
import pytest

from quasistatic_ref.cli.main import main
from tests.pages import EXAMPLES, ROOT, named_files, shell_lines

PAGE = (ROOT / "docs" / "studies.md").read_text("utf-8")
FILES = named_files(PAGE)
IN_C = """
format = "quasistatic-ref/study"
version = 2
time_limit = 20.0

[problems]
set = "contact-qp"
families = { contacts = 2, gaps = 2, infeasible = 1 }

[solvers.hildreth]
function = "hildreth.py:solve"

[[runs]]
solvers = ["hildreth"]
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, with the files of the page."""
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text, "utf-8")
    return tmp_path


def test_a_function_of_a_file_runs_in_a_study_of_ten_problems(folder, capsys):
    for line in shell_lines(PAGE):
        assert main(shlex.split(line)[1:]) == 0, line
    rows = pandas.read_parquet("study/rows.parquet")
    assert rows.groupby("solver").size().to_dict() == {"clarabel": 10, "daqp": 10, "nnls": 10}
    nnls = rows[rows.solver == "nnls"]
    assert (nnls[nnls.feasible].digits > 9).all()
    assert set(nnls[~nnls.feasible].claim) == {"infeasible"}
    assert "function:nnls" in Path("report/summary.md").read_text("utf-8")
    exec(FILES["rows.py"], {})  # how the page asks the rows
    assert "contacts/" in capsys.readouterr().out


@pytest.mark.extra("fast")  # a C compiler
def test_a_program_in_c_runs_in_a_study(folder):
    for name in ("hildreth.c", "hildreth.py"):
        shutil.copy(EXAMPLES / name, folder)
    lines = Path("hildreth.py").read_text("utf-8").splitlines()
    (command,) = (line.removeprefix("First: ") for line in lines if "cc -O2" in line)
    subprocess.run([*shlex.split(command), "-Wall"], check=True)
    Path("study.toml").write_text(IN_C, "utf-8")
    assert main(["study", "run", "study.toml", "--out", "study"]) == 0
    rows = pandas.read_parquet("study/rows.parquet")
    solved = rows[rows.feasible & (rows.outcome == "solved")]
    assert len(solved) >= 2
    assert (solved.digits > 9).all()
