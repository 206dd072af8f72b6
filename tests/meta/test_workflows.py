"""The workflow files call the parts of .ci/run, all of them, on every Python that is declared."""

import re
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


def called_parts(job):
    """The parts that a job calls; one that its matrix names stands for each of that list."""
    matrix = job.get("strategy", {}).get("matrix", {})
    for step in job["steps"]:
        for word in re.findall(r"^\.ci/run (.+)$", step.get("run", ""), re.MULTILINE):
            name = re.fullmatch(r"\$\{\{ matrix\.(\w+) \}\}", word)
            yield from matrix[name[1]] if name else word.split()


def test_every_part_is_a_function_and_the_workflows_call_each():
    functions = set(re.findall(r"^(\w+)\(\) \{$", RUN.read_text("utf-8"), re.MULTILINE))
    assert functions - {"environment", "installed", "site"} == {*parts()}
    assert {part for job in JOBS.values() for part in called_parts(job)} == {*parts()}
    assert len(parts()) > 5
