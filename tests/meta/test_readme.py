"""The README's commands are the ones that CI runs."""

import re
import sys
from pathlib import Path

from quasistatic_ref.scenario.scenario import load_scenario
from validation.tools.installs import COMMANDS, shell_lines

ROOT = Path(__file__).parents[2]


def bare(command):
    """A command without -q, which changes what is printed only, and without further extras."""
    return re.sub(r" -q\b", "", command).replace("[test,fast,jax,node,robots]", "[test]")


NAMED = re.compile(r"^\d\. `(\w+/\w+\.py)`: (.*)$", re.MULTILINE)


def test_the_functions_to_be_read_first_are_those_that_a_run_executes():
    """Every function that the reading path names runs in the first steps of bunny_grasp."""
    text = (ROOT / "README.md").read_text()
    package = ROOT / "quasistatic_ref"
    wanted = {
        (str(package / file), name.partition(".")[2] or name)
        for file, words in NAMED.findall(text)
        for name in re.findall(r"`([A-Za-z_]+(?:\.\w+)?)`", words)
        if name != "StepProblem"
    } | {(str(package / "step/problem.py"), "__init__")}
    assert 5 <= len(NAMED.findall(text)) <= 6
    executed = set()

    def note(frame, event, argument):
        if event == "call":
            executed.add((frame.f_code.co_filename, frame.f_code.co_name))

    scenario = load_scenario("bunny_grasp", steps=2)
    sys.setprofile(note)
    try:
        scenario.run(progress=False)
    finally:
        sys.setprofile(None)
    assert wanted - executed == set()
    quick = package / "optional" / "fast"
    assert [file for file, _ in executed if file.startswith(str(quick))] == []
    named = re.findall(r"`(\w+/\w+\.py)`", text[text.index("## Read it") :])
    assert [name for name in named if not (package / name).is_file()] == []


def test_the_tests_command_is_the_one_that_ci_runs():
    testing = [c for c in shell_lines((ROOT / "README.md").read_text()) if "pytest" in c]
    assert len(testing) == 1
    lines = [line.strip() for line in (ROOT / ".ci" / "run").read_text().splitlines()]
    assert bare(testing[0]) in [bare(line) for line in lines]


def test_every_command_that_it_lists_is_tried_from_an_installed_wheel():
    text = (ROOT / "README.md").read_text("utf-8")
    listed = re.search(r"` lists the commands:(.*?)\. The$", text, re.MULTILINE | re.DOTALL)[1]
    names = set()
    for one in re.findall(r"`([a-z][^`]*)`", listed):
        name, _, rest = one.partition(" ")
        actions = re.match(r"[a-z|]+", rest)
        names |= {f"{name} {action}" for action in actions[0].split("|")} if actions else {name}
    assert {"demo", "run", "vectors check", "study run", "study pack", "bench"} <= names
    tried = "\n".join(line for lines in COMMANDS.values() for line in lines)
    assert {name for name in names if not re.search(rf"quasistatic-ref {name}\b", tried)} == set()
