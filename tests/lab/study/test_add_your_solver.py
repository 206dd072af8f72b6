"""docs/guides/add_your_solver.md: every file and command of the page, as it stands there."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.figures import study_images
from quasistatic_ref.lab.study.store.store import contents
from quasistatic_ref.optional.fast.compiled.library import compiler
from tests.lab.study import made_store

DOCS = Path(__file__).parents[3] / "docs"
PAGE = (DOCS / "guides" / "add_your_solver.md").read_text("utf-8")
PROGRAM = (DOCS / "examples" / "hildreth.c").read_text("utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def folder(tmp_path, monkeypatch, importable):
    """An empty folder in which what the page shows was done: files, a compiler, a package."""
    monkeypatch.chdir(tmp_path)
    (function,), (study, entries) = map(blocks, ("python", "toml"))
    Path("my_solver.py").write_text(function)
    Path("my_study.toml").write_text(study)
    Path("hildreth.c").write_text(PROGRAM)
    command = [*compiler(), "-O2", "-Wall", "-o", "hildreth", "hildreth.c", "-lm"]
    made = subprocess.run(command, capture_output=True, text=True)
    assert (made.returncode, made.stderr) == (0, "")
    info = Path("my_solver-1.0.dist-info")
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-solver\nVersion: 1.0\n")
    lines = entries.replace('[project.entry-points."quasistatic_ref.solvers"]',
                            "[quasistatic_ref.solvers]").replace('"', "")  # fmt: skip
    (info / "entry_points.txt").write_text(lines)
    importable(tmp_path)
    yield tmp_path
    sys.modules.pop("my_solver", None)


@pytest.mark.extra("fast")  # a part of the page is compiled
def test_every_command_of_the_page_does_what_it_says(folder, monkeypatch):
    """Both solvers stand in every table; on problems with a solution they have 12 digits."""
    ran = []
    for line in "".join(blocks("sh")).splitlines():
        words = shlex.split(line, comments=True)
        if words[2] == "merge":
            made_store.of_another_machine("study", Path("other_study"))
            monkeypatch.setattr(study_images, "images", lambda *_: {"png": b"", "svg": b""})
        assert main(words[1:]) == 0, line
        ran.append(words[2])
    assert ran == ["ask", "run", "report", "ask", "merge", "report"]
    rows = [row for row in contents("study").rows if row["repetition"] == 0]
    by = {name: [row for row in rows if row["solver"] == name] for name in ("nnls", "hildreth")}
    assert len(by["nnls"]) == len(by["hildreth"]) == 10
    feasible = [row for row in by["nnls"] if row["feasible"]]
    assert all(row["outcome"] == "solved" and row["digits"]["delta_q"] > 9 for row in feasible)
    solved = [row for row in by["hildreth"] if row["outcome"] == "solved" and row["feasible"]]
    assert len(solved) >= 3
    assert all(row["digits"]["delta_q"] > 9 for row in solved)
    report = Path("report/report.md").read_text()
    for title in (
        "Each solver",
        "Setting default",
        "Claims, natural",
        "How the calls ended",
    ):
        table = report.partition(f"**{title}")[2].partition("\n**")[0]
        assert "nnls" in table, title
        assert "hildreth" in table, title
    assert "nnls | callable | theirs" in Path("merged/report/report.md").read_text()
