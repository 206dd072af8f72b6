"""The README's commands are the ones that CI runs."""

import re
from pathlib import Path

from validation.installs import COMMANDS, shell_lines

ROOT = Path(__file__).parents[2]


def without_quiet(command):
    """A command without -q, which changes what is printed only."""
    return re.sub(r" -q\b", "", command)


def test_commands_are_read_from_shell_blocks_only():
    text = "```sh\n# a comment\n$ one --two  # three\n```\n```python\nfour()\n```\n`five`\n"
    assert shell_lines(text) == ("one --two",)


ABOUT = 50
"""Lines to which the README rounds the length of the files to be read first."""


def test_the_files_to_be_read_first_are_there_and_as_long_as_it_says():
    text = (ROOT / "README.md").read_text()
    files = re.findall(r"^\d\. `(\w+/\w+\.py)`", text, re.MULTILINE)
    assert [Path(name).stem for name in files] == [
        "problem", "friction", "standard_form", "optimality", "simulator",
    ]  # fmt: skip
    package = ROOT / "quasistatic_ref"
    lines = sum(len((package / name).read_text().splitlines()) for name in files)
    assert f"five files of about {ABOUT * round(lines / ABOUT)} lines in total" in text
    named = re.findall(r"`(\w+/\w+\.py)`", text[text.index("## Read it") :])
    assert [name for name in named if not (package / name).is_file()] == []


def test_the_tests_command_is_the_one_that_ci_runs():
    testing = [c for c in shell_lines((ROOT / "README.md").read_text()) if "pytest" in c]
    assert len(testing) == 1
    lines = [line.strip() for line in (ROOT / ".ci" / "run").read_text().splitlines()]
    assert without_quiet(testing[0]) in [without_quiet(line) for line in lines]


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
