"""``figures [NAME...]``: run the scripts of the gallery, and write their figures."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.quoting import suggestion


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    words = "script of the gallery (default: all scripts)"
    parser.add_argument("names", nargs="*", metavar="NAME", help=words)
    parser.add_argument(
        "--style",
        default="paper",
        metavar="STYLE",
        help="paper (default), slides, poster, one of matplotlib's, or a file such as my.mplstyle",
    )
    shared.add(parser, "--out", default="figures")


def run(options: argparse.Namespace) -> int:
    """Make the figures one by one.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    from quasistatic_ref.lab.figures.gallery import gallery_figure, gallery_scripts
    from quasistatic_ref.optional.show.figures.style import figure_style, figure_written
    from quasistatic_ref.text.content import writable_folder

    scripts = gallery_scripts()
    for name in options.names:
        if name not in scripts:
            problem = f"is not a script of the gallery{suggestion(name, scripts)}"
            raise InputError(problem, field="NAME", value=name)
    with figure_style(options.style):
        writable_folder(options.out)
        for name in options.names or scripts:
            shared.progress_line(options, f"{name} ...")
            for path in figure_written(gallery_figure(scripts[name]), options.out, name):
                print(path)
    return 0
