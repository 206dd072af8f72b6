"""``figures [NAME...]``: make the figures of the examples, as PNG and PDF."""

import argparse
import sys

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="all by default, but those whose extra is missing"
    )
    parser.add_argument(
        "--style",
        default="paper",
        metavar="STYLE",
        help="paper (default), slides, poster, one of matplotlib's, or a file such as my.mplstyle",
    )
    parser.add_argument(
        "--numbers", action="store_true", help="print what each example comes to, too"
    )
    shared.add(parser, "--out", default="figures")


def run(options: argparse.Namespace) -> int:
    """Make them one by one.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    from quasistatic_ref.formats.files import writable_folder
    from quasistatic_ref.lab.examples.gallery import EXAMPLES, example, figure_of
    from quasistatic_ref.optional.show.figures.style import figure_style, figure_written

    for name in options.names:
        if name not in EXAMPLES:
            problem = f"is not a figure{suggestion(name, EXAMPLES)}"
            raise InputError(problem, field="NAME", value=name)
    with figure_style(options.style):
        writable_folder(options.out)
        for name in options.names or EXAMPLES:
            shared.progress_line(options, f"{name} ...")
            try:
                figure = figure_of(name)
            except InputError as error:  # a robot of an extra that is not installed
                if options.names:
                    raise
                print(f"quasistatic-ref: {name} was not made: {error}", file=sys.stderr)
                continue
            if options.numbers:
                for what, value in example(name).main().items():
                    print(f"{what}: {value:.6g}")
            for path in figure_written(figure, options.out, name):
                print(path)
    return 0
