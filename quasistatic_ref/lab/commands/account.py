"""``account RUN.npz``: what happened in a run, in numbers."""

import argparse
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import about_file
from quasistatic_ref.formats.files import bytes_written
from quasistatic_ref.parts import needing
from quasistatic_ref.simulate.trajectory import load_trajectory


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("trajectory", type=Path, help="a trajectory file (.npz)")
    shared.add(parser, "--json")
    parser.add_argument(
        "--figure", type=Path, metavar="FILE", help="write its figure, a page of PNG"
    )


def run(options: argparse.Namespace) -> int:
    """Print the account, and write what was asked for."""
    with needing("account"):
        from quasistatic_ref.optional.doctor import telling
    trajectory = load_trajectory(options.trajectory)
    with about_file(options.trajectory):
        account = trajectory.account()
    if options.figure is not None:
        with needing("--figure"):
            from quasistatic_ref.optional.show.figures.account import page
        bytes_written(options.figure, page(account))
    if options.json:
        shared.print_json({**account.numbers, "missing": list(account.missing)})
        return 0
    for line in telling.lines(account):
        shared.print_wrapped(line, "    ")
    return 0
