"""The README's commands are the ones that CI runs."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FENCE = re.compile(r"^```(?:sh|bash|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def commands(markdown):
    """Every command line in the fenced shell blocks of a text, without prompts and comments."""
    lines = [line for block in FENCE.findall(markdown) for line in block.splitlines()]
    stripped = [line.removeprefix("$ ").partition(" #")[0].strip() for line in lines]
    return [line for line in stripped if line and not line.startswith("#")]


def without_quiet(command):
    """A command without -q, which changes what is printed only."""
    return re.sub(r" -q\b", "", command)


def test_commands_are_read_from_shell_blocks_only():
    text = "```sh\n# a comment\n$ one --two  # three\n```\n```python\nfour()\n```\n`five`\n"
    assert commands(text) == ["one --two"]


def test_the_tests_command_is_the_one_that_ci_runs():
    testing = [c for c in commands((ROOT / "README.md").read_text()) if "pytest" in c]
    assert len(testing) == 1
    lines = [line.strip() for line in (ROOT / ".ci" / "run").read_text().splitlines()]
    assert without_quiet(testing[0]) in [without_quiet(line) for line in lines]
