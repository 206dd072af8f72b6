"""``bench``: what a step costs, compared with the solver alone and with other ways to take it."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.formats.files import json_text, text_written, writable_folder
from quasistatic_ref.lab.bench.report import page, paper_sentence, promise_rows
from quasistatic_ref.lab.bench.tables import tables


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "--quick", action="store_true", help="a little of everything, to see that it runs"
    )
    shared.add(parser, "--out", default="benchmarks")
    shared.add(parser, "--json")


def run(options: argparse.Namespace) -> int:
    """Measure and write the tables; exit status 1 if a promise does not hold."""
    writable_folder(options.out)
    found = tables(options.quick, lambda name: shared.progress_line(options, f"{name} ..."))
    text_written(options.out / "bench.json", json_text(found) + "\n")
    text_written(options.out / "bench.md", page(found))
    status = int(any(promise["holds"] is False for promise in found["promises"]))
    if options.json:
        shared.print_json(found)
        return status
    shared.print_rows(promise_rows(found["promises"]))
    print(paper_sentence(found))
    print(f"wrote bench.json and bench.md to {options.out}")
    return status
