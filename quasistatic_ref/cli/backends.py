"""``backends``: the solvers that can be chosen here."""

import argparse
from importlib.util import find_spec

from quasistatic_ref.cli import options as shared
from quasistatic_ref.parts import is_there
from quasistatic_ref.solve.backends import (
    BACKENDS,
    BY_CVXPY,
    DAQP,
    DEFAULT,
    NONE,
    QPSOLVERS,
    backend_names,
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "--json")


def run(options: argparse.Namespace) -> int:
    """Print the table of backends."""
    known = backend_names()
    quick = DAQP if is_there("daqp_solver") and find_spec(DAQP) else None
    if options.json:
        shared.print_json({"default": DEFAULT, "default_of_fast": quick, "installed": known})
        return 0
    rows: list[tuple[str, ...]] = [("backend", "through cvxpy", "through qpsolvers", "method")]
    for entry in (entry for entry in BACKENDS.values() if not entry.no_steps):
        name = entry.name
        name += " (default)" if name == DEFAULT else ""
        name += " (default with --fast)" if entry.name == quick else ""
        by_cvxpy = BY_CVXPY if entry.name == DAQP else entry.name
        reached = [key if key in known else "-" for key in (by_cvxpy, QPSOLVERS + entry.name)]
        rows.append((name, *reached, entry.method))
    rows.append((NONE, "-", "-", "exact method from a cold start"))
    shared.print_rows(rows)
    return 0
