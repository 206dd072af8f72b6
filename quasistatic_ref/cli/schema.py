"""``schema``: the JSON Schema of scenario files, for editors."""

import argparse
import json

from quasistatic_ref.simulate.schema import scenario_schema


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command: there are none."""


def run(options: argparse.Namespace) -> int:
    """Print it."""
    print(json.dumps(scenario_schema(), indent=2))
    return 0
