"""``bench``: what a step costs, plain and fast, unproved and proved, next to MuJoCo's."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.lab.bench.report import measured, page, rows
from quasistatic_ref.text.content import text_written, writable_folder
from quasistatic_ref.text.json_text import json_text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "--quick", action="store_true", help="a few steps of two scenes, to see that it runs"
    )
    shared.add(parser, "--out", default="benchmarks")
    shared.add(parser, "--json")


def run(options: argparse.Namespace) -> int:
    """Measure and write the figures."""
    writable_folder(options.out)
    tables = measured(options.quick, lambda name: shared.progress_line(options, f"{name} ..."))
    text_written(options.out / "bench.json", json_text(tables) + "\n")
    text_written(options.out / "bench.md", page(tables))
    if options.json:
        shared.print_json(tables)
        return 0
    shared.print_rows(rows(tables["scenes"]))
    print(f"wrote bench.json and bench.md to {options.out}")
    return 0
