"""``schema``: the JSON Schema of a kind of file, for editors and other programs."""

import argparse
import json
from collections.abc import Mapping
from typing import Any

from quasistatic_ref.files import solution, trajectory
from quasistatic_ref.files.scenario.scenario_table import (
    CONTACT,
    SHAPE,
    TABLES,
    TARGET,
    TOP,
    WAYPOINT,
    WRENCH,
)
from quasistatic_ref.files.scenario.world_solids import SOLIDS
from quasistatic_ref.lab.json_schema import BOUNDED, json_schema
from quasistatic_ref.parts import needing
from quasistatic_ref.step import text

RULES: dict[str, Mapping[str, Any]] = {
    CONTACT: {
        "anyOf": [
            {"required": ["mu_omega"]},
            {"required": ["rows"], "properties": {"rows": {"enum": [4]}}},
        ]
    },
    WRENCH: {"anyOf": [{"required": ["force"]}, {"required": ["torque"]}]},
    SHAPE: {"oneOf": [{"required": [kind]} for kind in SOLIDS]},
    WAYPOINT: {"additionalProperties": TARGET, "minProperties": 2},
}
"""What a kind of table of a scenario asks for beyond its fields."""


def scenario_schema() -> dict[str, Any]:
    """The JSON Schema of a scenario file."""
    return json_schema("A scenario", TABLES, RULES, TOP, BOUNDED)


def opinion_schema() -> dict[str, Any]:
    """The JSON Schema of a second opinion."""
    with needing("opinion"):
        from quasistatic_ref.optional.mujoco.opinion import TABLES as TABLES_OF_OPINION
        from quasistatic_ref.optional.mujoco.opinion import TOP as TOP_OF_OPINION
    return json_schema("A second opinion", TABLES_OF_OPINION, {}, TOP_OF_OPINION, BOUNDED)


def step_schema() -> dict[str, Any]:
    """The JSON Schema of a step."""
    return json_schema("A step", text.TABLES, {}, text.TOP)


def solution_schema() -> dict[str, Any]:
    """The JSON Schema of a solution, of whatever status and cone."""
    top, claims = solution.TABLES[solution.TOP], solution.TABLES[solution.CERTIFICATE]
    head, answer = [*top][:5], [*top][5:-1]
    rules: dict[str, Mapping[str, Any]] = {
        solution.TOP: {
            "required": head,
            "oneOf": [{"required": answer}, {"required": ["farkas"]}],
        },
        solution.CERTIFICATE: {"required": [*claims][:1]},
    }
    return json_schema("A solution", solution.TABLES, rules, solution.TOP)


def header_schema() -> dict[str, Any]:
    """The JSON Schema of the header of a trajectory."""
    return json_schema("The header of a trajectory", trajectory.TABLES, {}, trajectory.TOP)


SCHEMAS = {
    "scenario": scenario_schema,
    "step": step_schema,
    "solution": solution_schema,
    "header": header_schema,
    "opinion": opinion_schema,
}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "file", nargs="?", choices=tuple(SCHEMAS), default="scenario", metavar="KIND",
        help="scenario (default), step, solution, header (of a trajectory) or opinion",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    """Print the schema."""
    print(json.dumps(SCHEMAS[options.file](), indent=2))
    return 0
