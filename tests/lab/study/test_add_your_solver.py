"""The pages for authors of solvers: every file and command, as they stand there."""

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pandas
import pytest

from quasistatic_ref.cli.main import main

DOCS = Path(__file__).parents[3] / "docs"
FILES = {"add_your_solver": ("my_solver", "my_study"), "solver_in_any_language": ("hildreth",) * 2}


@pytest.fixture
def commands(request, tmp_path, monkeypatch):
    """Write the files of a page into an empty folder; a function that runs its commands."""
    monkeypatch.chdir(tmp_path)
    page = (DOCS / "guides" / f"{request.param}.md").read_text("utf-8")
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    function, study = FILES[request.param]
    Path(f"{function}.py").write_text(next(text for kind, text in blocks if kind == "python"))
    Path(f"{study}.toml").write_text(next(text for kind, text in blocks if kind == "toml"))
    shutil.copy(DOCS / "examples" / "hildreth.c", ".")
    for line in "".join(text for kind, text in blocks if kind == "sh").splitlines():
        words = shlex.split(line)
        if words[0] == "cc":
            subprocess.run(["cc", *words[1:], "-Wall"], check=True)
        else:
            assert main(words[1:]) == 0, line
    return blocks


@pytest.mark.parametrize("commands", ["add_your_solver"], indirect=True)
def test_a_function_of_a_file_runs_in_a_study_of_ten_problems(commands, capsys):
    rows = pandas.read_parquet("study/rows.parquet")
    assert rows.groupby("solver").size().to_dict() == {"clarabel": 10, "daqp": 10, "nnls": 10}
    nnls = rows[rows.solver == "nnls"]
    assert (nnls[nnls.feasible].digits > 9).all()
    assert set(nnls[~nnls.feasible].claim) == {"infeasible"}
    assert "function:nnls" in Path("report/summary.md").read_text("utf-8")
    exec(commands[-1][1], {})  # how the page asks the rows
    assert "contacts/" in capsys.readouterr().out


@pytest.mark.parametrize("commands", ["solver_in_any_language"], indirect=True)
@pytest.mark.extra("fast")  # a C compiler
def test_a_program_runs_in_a_study_and_its_problems_have_the_arrays_of_the_page(commands):
    rows = pandas.read_parquet("hildreth_study/rows.parquet")
    solved = rows[(rows.solver == "hildreth") & rows.feasible & (rows.outcome == "solved")]
    assert len(solved) >= 2
    assert (solved.digits > 9).all()
    with np.load("problems/contact-qp-natural.npz") as arrays:
        names = ("H", "g", "A", "b", "x", "net", "slack", "lam")
        H, g, A, b, x, net, slack, lam = (arrays[f"0/{name}"] for name in names)
    np.testing.assert_allclose(H @ x - g, A.T @ lam, atol=1e-12)
    np.testing.assert_allclose(net, A.T @ lam, atol=1e-12)
    np.testing.assert_allclose(slack, A @ x - b, atol=1e-12)
    assert lam.min() >= 0
