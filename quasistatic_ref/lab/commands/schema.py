"""``schema``: the JSON Schema of scenario or study files, for editors."""

import argparse
import json

from quasistatic_ref.lab.study.file.fields import study_schema
from quasistatic_ref.scenario.scenario_table import scenario_schema

SCHEMAS = {"scenario": scenario_schema, "study": study_schema}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "file", nargs="?", choices=tuple(SCHEMAS), default="scenario", metavar="KIND",
        help="scenario (default) or study",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    """Print it."""
    print(json.dumps(SCHEMAS[options.file](), indent=2))
    return 0
