"""What the README shows is what runs: its commands, its example, the order of reading."""

import re
import sys
from pathlib import Path

import numpy as np

from quasistatic_ref.cli.main import COMMANDS as NAMES
from quasistatic_ref.scenario.scenario import load_scenario
from tests.quoted import printed
from validation.tools.installs import COMMANDS, shell_lines

ROOT = Path(__file__).parents[2]


def bare(command):
    """A command without -q, which changes what is printed only, and without further extras."""
    return re.sub(r" -q\b", "", command).replace("[test,fast,jax,node,robots]", "[test]")


def test_the_example_prints_what_the_readme_shows(capsys):
    text = (ROOT / "README.md").read_text("utf-8")
    (example,) = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    exec(compile(example, "README.md", "exec"), {})
    shown = [line.rsplit(maxsplit=1) for line in printed(text)[0].splitlines()]
    found = [line.rsplit(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert [answer for answer, _ in found] == [answer for answer, _ in shown]
    # A solver's own digits depend on the instructions of the processor.
    digits = [[int(own) for _, own in lines] for lines in (found, shown)]
    assert np.abs(np.subtract(*digits)).max() <= 1


def test_a_run_executes_the_files_to_be_read_first_and_nothing_that_is_only_quick():
    """Of the first steps of bunny_grasp, on the plain path."""
    text = (ROOT / "docs" / "contributing.md").read_text("utf-8")
    reading = text[text.index("## Read the code") : text.index("## Where things are")]
    package, executed = ROOT / "quasistatic_ref", set()
    scenario = load_scenario("bunny_grasp", steps=2)
    sys.setprofile(lambda frame, *_: executed.add(frame.f_code.co_filename))
    try:
        scenario.run(progress=False)
    finally:
        sys.setprofile(None)
    first = re.findall(r"^\d\. `(\w+/\w+\.py)`", reading, re.MULTILINE)
    assert 5 <= len(first) <= 6
    assert {str(package / file) for file in first} <= executed
    assert not [file for file in executed if file.startswith(str(package / "optional" / "fast"))]
    named = re.findall(r"`(\w+/\w+\.py)`", reading)
    assert [name for name in named if not (package / name).is_file()] == []


def test_the_tests_command_is_the_one_that_ci_runs():
    testing = [c for c in shell_lines((ROOT / "README.md").read_text()) if "pytest" in c]
    assert len(testing) == 1
    lines = [line.strip() for line in (ROOT / ".ci" / "run").read_text().splitlines()]
    assert bare(testing[0]) in [bare(line) for line in lines]


def test_every_command_of_the_guide_is_tried_from_an_installed_wheel():
    text = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    table = text[text.index("## The commands") : text.index("## Completion")]
    cells = re.findall(r"^\| (`.*?`) \|", table, re.MULTILINE)
    names = {
        re.match(r"[a-z]+(?: [a-z]+)?", one)[0]
        for c in cells
        for one in re.findall(r"`([^`]+)`", c)
    }
    assert {name.partition(" ")[0] for name in names} == {*NAMES}
    tried = "\n".join(line for lines in COMMANDS.values() for line in lines)
    assert {name for name in names if not re.search(rf"quasistatic-ref {name}\b", tried)} == set()
