"""``backends``: the solvers that can be chosen here."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    DEFAULT_OF_RUNS,
    QPSOLVERS,
    installed,
    installed_backends,
)

DEFAULTS = {DEFAULT: " (default of solve)", DEFAULT_OF_RUNS: " (default of run)"}
"""Of a run without DAQP it is Clarabel too, which then has the second word."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "--json")


def run(options: argparse.Namespace) -> int:
    """Print the table of backends."""
    known, native = installed_backends(), installed("native")
    if options.json:
        defaults = {"default": DEFAULT_OF_RUNS, "default_of_solve": DEFAULT}
        shared.print_json({**defaults, "installed": known, "native": native})
        return 0
    rows: list[tuple[str, ...]] = [
        ("backend", "through cvxpy", "through qpsolvers", "native", "method")
    ]
    for entry in (entry for entry in BACKENDS.values() if entry.steps):
        name = f"{entry.name}{DEFAULTS.get(entry.name, '')}"
        reached = [key if key in known else "-" for key in (entry.name, QPSOLVERS + entry.name)]
        rows.append((name, *reached, "yes" if entry.name in native else "-", entry.method))
    shared.print_rows(rows)
    return 0
