"""The workflow files call the parts of .ci/run, all of them, on every Python that is declared."""

import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
RUN = ROOT / ".ci" / "run"
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
JOBS = {
    f"{path.stem}: {name}": job
    for path in WORKFLOWS
    for name, job in yaml.safe_load(path.read_text("utf-8"))["jobs"].items()
}


def parts():
    """The names that .ci/run takes."""
    return re.search(r"^parts=\((.*)\)$", RUN.read_text("utf-8"), re.MULTILINE)[1].split()


def called(job):
    """The parts that a job calls; one that its matrix names stands for each of that list."""
    matrix = job.get("strategy", {}).get("matrix", {})
    for step in job["steps"]:
        for word in re.findall(r"^\.ci/run (.+)$", step.get("run", ""), re.MULTILINE):
            name = re.fullmatch(r"\$\{\{ matrix\.(\w+) \}\}", word)
            yield from matrix[name[1]] if name else word.split()


def test_every_part_is_a_function_and_the_workflows_call_each():
    functions = set(re.findall(r"^(\w+)\(\) \{$", RUN.read_text("utf-8"), re.MULTILINE))
    assert functions - {"environment", "site"} == {*parts()}
    assert {part for job in JOBS.values() for part in called(job)} == {*parts()}
    assert len(parts()) > 5


def test_the_tests_run_on_linux_and_macos_with_every_python():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    declared = [line.rpartition(" ")[2] for line in project["classifiers"] if ":: 3." in line]
    (job,) = (job for job in JOBS.values() if [*called(job)] == ["tests"])
    matrix = job["strategy"]["matrix"]
    assert matrix["python"] == declared
    assert {name.partition("-")[0] for name in matrix["os"]} == {"ubuntu", "macos"}
    (setup,) = (step for step in job["steps"] if "setup-python" in step.get("uses", ""))
    assert setup["with"]["python-version"] == "${{ matrix.python }}"


def test_a_part_that_does_not_exist_is_refused_before_any_runs():
    done = subprocess.run([RUN, "lint", "linnt"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == f"linnt is no part; there are: {' '.join(parts())}\n"
    assert done.stdout == ""


STUB = """#!/bin/sh
echo "$(basename "$0") $*" | sed "s#$TMPDIR/[^/ ]*#MADE#g" >> "$LOG"
case "$*" in *"$FAILS"*) exit 1 ;; esac
"""
"""A program that only says how it was called, and fails where it is to."""


@pytest.fixture
def ran(tmp_path):
    """Status and commands of .ci/run in a folder whose programs are stubs."""
    programs = ("python3", "chromium", "node")
    stubs = {"path": programs, ".venv/bin": ("pip", "python", "ruff", "mypy")}
    for place, names in stubs.items():
        folder = tmp_path / place
        folder.mkdir(parents=True)
        for name in names:
            (folder / name).write_text(STUB)
            (folder / name).chmod(0o755)
    (tmp_path / ".ci").mkdir()
    (tmp_path / "made").mkdir()
    shutil.copy(RUN, tmp_path / ".ci" / "run")

    def run(*names, fails="nothing fails"):
        log = tmp_path / "log"
        log.unlink(missing_ok=True)
        path = f"{tmp_path / 'path'}{os.pathsep}{os.environ['PATH']}"
        own = {"PATH": path, "LOG": log, "TMPDIR": tmp_path / "made", "FAILS": fails}
        done = subprocess.run(
            [tmp_path / ".ci" / "run", *names], env=own, capture_output=True, check=False
        )
        return done.returncode, log.read_text().splitlines()

    return run


def without_environment(lines):
    return {line for line in lines if not line.startswith(("pip ", "python3 "))}


def test_without_a_name_every_part_runs(ran):
    status, together = ran()
    assert status == 0
    each = [line for name in parts() for line in ran(name)[1]]
    assert without_environment(together) == without_environment(each)
    assert together[:3] == [
        "python3 -m venv .venv",
        "pip install -q -e .[test]",
        "python -m pytest -n 2",
    ]


@pytest.mark.parametrize(
    ("fails", "last"),
    [("venv", "python3 -m venv .venv"), ("pytest", "python -m pytest -n 2"),
     ("format", "ruff format --check .")],
)  # fmt: skip
def test_the_first_failure_ends_it(ran, fails, last):
    status, lines = ran(fails=fails)
    assert status == 1
    assert lines[-1] == last


@pytest.mark.parametrize("fails", ["doctest", "notebooks", "check_sdist"])
def test_a_failure_of_a_part_that_runs_next_to_others_is_the_status(ran, fails):
    assert ran(fails=fails)[0] == 1
