"""``backends``: the solvers that can be chosen here."""

from __future__ import annotations

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.solve.backends import BACKENDS, DEFAULT, QPSOLVERS, installed_backends
from quasistatic_ref.solve.native import native_backends


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print the table of backends."""
    installed = installed_backends()
    if options.json:
        record = {"default": DEFAULT, "installed": installed, "native": native_backends()}
        shared.print_json(record)
        return 0
    rows: list[tuple[str, ...]] = [
        ("backend", "through cvxpy", "through qpsolvers", "native", "method")
    ]
    for entry in BACKENDS.values():
        name = f"{entry.name} (default)" if entry.name == DEFAULT else entry.name
        roads = [key if key in installed else "-" for key in (entry.name, QPSOLVERS + entry.name)]
        native = "yes" if entry.name in native_backends() else "-"
        rows.append((name, *roads, native, entry.method))
    shared.print_rows(rows)
    return 0
