"""``serve [SCENE ...]``: answer steps that another program asks for, over a pipe."""

import argparse
import sys

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.oracle.pipes import lines_served
from quasistatic_ref.lab.oracle.served import Scenes


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    words = "scenes that are known from the start: TOML files, or names of installed ones"
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=words)
    shared.add(parser, *shared.SOLVER, "--law", "--set", "--root")


def run(options: argparse.Namespace) -> int:
    """Serve until standard input ends.

    Raises
    ------
    InputError
        If a scene cannot be loaded, or standard input is closed.
    """
    scenes = Scenes(shared.scenario_settings(options), options.roots)
    for scene in options.scenes:
        scenes.add(scene)
    if sys.stdin is None:
        raise InputError("is closed: requests are read from it", field="standard input")
    lines_served(scenes, sys.stdin.buffer, sys.stdout)
    return 0
