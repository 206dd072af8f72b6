"""Every extra has commands that prove it, and its line in the guide."""

import re
import tomllib
from pathlib import Path

from quasistatic_ref.cli import main
from quasistatic_ref.cli.main import _actions as leaves
from quasistatic_ref.cli.main import command_parser
from validation.tools.installs import COMMANDS, REFUSED

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_every_extra_has_commands_and_a_line_in_the_guide():
    assert {*COMMANDS} == {"base", *EXTRAS}
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    guide = guide[: guide.index("## The commands")]
    assert {*re.findall(r"^\| `(\w+)` \|", guide, re.MULTILINE)} == {*EXTRAS}


def test_every_command_of_the_help_is_tried_as_an_installed_user():
    """But one that computes for minutes: tests/lab/vectors/test_commands.py has a part of it."""
    tried = " ".join(line for lines in COMMANDS.values() for line in lines)
    commands = {leaf.prog for leaf in leaves(command_parser(main.COMMANDS))}
    assert {name for name in commands if name not in tried} == {"quasistatic-ref vectors generate"}


def test_an_extra_that_a_refusal_names_exists():
    named = {
        re.search(r"\[(\w+)\]", text)[1] for lines in REFUSED.values() for text in lines.values()
    }
    assert named <= {*EXTRAS}
    assert len(named) > 3


def test_all_is_every_extra_for_use():
    (said,) = EXTRAS["all"]
    found = {*re.search(r"\[(.*)\]", said)[1].split(",")}
    assert {*EXTRAS} - found == {"all", "test", "docs"}
