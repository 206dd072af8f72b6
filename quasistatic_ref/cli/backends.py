"""``backends``: the solvers that can be chosen here."""

from __future__ import annotations

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    QPSOLVERS,
    installed,
    installed_backends,
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print the table of backends."""
    known, native = installed_backends(), installed("native")
    if options.json:
        shared.print_json({"default": DEFAULT, "installed": known, "native": native})
        return 0
    rows: list[tuple[str, ...]] = [
        ("backend", "through cvxpy", "through qpsolvers", "native", "method")
    ]
    for entry in (entry for entry in BACKENDS.values() if entry.steps):
        name = f"{entry.name} (default)" if entry.name == DEFAULT else entry.name
        asked = [key if key in known else "-" for key in (entry.name, QPSOLVERS + entry.name)]
        rows.append((name, *asked, "yes" if entry.name in native else "-", entry.method))
    shared.print_rows(rows)
    return 0
