"""``account RUN.npz``: what happened in a run."""

import argparse
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import about_file
from quasistatic_ref.formats.files import bytes_written, text_written
from quasistatic_ref.parts import needing
from quasistatic_ref.simulate.trajectory import trajectory_read


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("trajectory", type=Path, help="a trajectory file (.npz)")
    shared.add(parser, "--json")
    parser.add_argument(
        "--html", type=Path, metavar="FILE", help="write it as a page, with its figure"
    )
    parser.add_argument(
        "--figure", type=Path, metavar="FILE", help="write its figure, a page of PNG"
    )


def run(options: argparse.Namespace) -> int:
    """Print the account, and write what was asked for."""
    with needing("account"):
        from quasistatic_ref.optional.account import words
    trajectory = trajectory_read(options.trajectory)
    with about_file(options.trajectory):
        account = trajectory.account()
    png = b""
    if options.figure is not None or options.html is not None:
        with needing("--figure and --html"):
            from quasistatic_ref.optional.show.figures.account import page
        png = page(account)
    if options.figure is not None:
        bytes_written(options.figure, png)
    if options.html is not None:
        text_written(options.html, words.html(options.trajectory.name, account, png))
    if options.json:
        shared.print_json(words.tables(account))
        return 0
    for line in words.lines(account):
        shared.print_wrapped(line.lstrip(), "    ", "  " if line.startswith(" ") else "")
    return 0
