"""The workflow files call the parts of .ci/run, all of them, on every Python that is declared."""

import re
import tomllib
from pathlib import Path

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
