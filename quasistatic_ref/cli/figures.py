"""``figures [NAME...]``: make figures, as PNG and PDF."""

from __future__ import annotations

import argparse
import sys

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError, suggestion


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("names", nargs="*", metavar="NAME", help="all of them by default")
    shared.add_out(parser, "figures")


def run(options: argparse.Namespace) -> int:
    """Make them one by one.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    from quasistatic_ref.figures.gallery import FIGURES
    from quasistatic_ref.figures.style import figure_written
    from quasistatic_ref.files import writable_folder

    for name in options.names:
        if name not in FIGURES:
            problem = f"is no figure{suggestion(name, FIGURES)}"
            raise InputError(problem, field="NAME", value=name)
    writable_folder(options.out)
    for name in options.names or FIGURES:
        print(f"{name} ...", file=sys.stderr)
        for path in figure_written(FIGURES[name](), options.out, name):
            print(path)
    return 0
