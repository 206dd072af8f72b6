"""The sheet of calls: each call is Python, and each name in it is public."""

import ast
import re
from pathlib import Path

import pytest

import quasistatic_ref as qr
from quasistatic_ref.cli import main
from quasistatic_ref.cli.main import command_parser

SHEET = (Path(__file__).parents[1] / "docs" / "sheet.md").read_text("utf-8")
CALLS = [call for call in re.findall(r"`([^`]+)`", SHEET) if not call.startswith("quasistatic-ref")]
COMMANDS = re.findall(r"`quasistatic-ref (\w+)", SHEET)
OWNERS = {
    "run": qr.Trajectory,
    "recorder": qr.Recorder,
    "scenario": qr.Scenario,
    "simulator": qr.Simulator,
    "solution": qr.StepSolution,
    "system": qr.System,
}
"""The class of each name that the sheet uses."""


def attributes(call):
    """(name, attribute) of each access to one of the sheet's names."""
    for node in ast.walk(ast.parse(call.replace("=,", "=None,").replace("=)", "=None)"))):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield node.value.id, node.attr


@pytest.mark.parametrize("call", CALLS)
def test_the_names_of_a_call_exist(call):
    for name, attribute in attributes(call):
        if name == "qr":
            assert attribute in qr.__all__
        elif name in OWNERS:
            owner = OWNERS[name]
            fields = getattr(owner, "__dataclass_fields__", {})
            assert hasattr(owner, attribute) or attribute in fields


@pytest.mark.parametrize("command", sorted({*COMMANDS}))
def test_a_command_of_the_sheet_exists(command):
    assert f" {command} " in command_parser(main.COMMANDS).format_help()
