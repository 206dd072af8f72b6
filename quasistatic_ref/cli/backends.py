"""``backends``: the solvers that can be chosen here."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.parts import needing
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    NONE,
    QPSOLVERS,
    backend_names,
    installed,
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "--json")


def run(options: argparse.Namespace) -> int:
    """Print the table of backends."""
    known = backend_names()
    native = installed("native")
    quick = fast_default()
    if options.json:
        defaults = {"default": DEFAULT, "default_of_fast": quick}
        shared.print_json({**defaults, "installed": known, "native": native})
        return 0
    rows: list[tuple[str, ...]] = [
        ("backend", "through cvxpy", "through qpsolvers", "with --fast", "method")
    ]
    for entry in (entry for entry in BACKENDS.values() if entry.steps):
        name = entry.name
        name += " (default)" if name == DEFAULT else ""
        name += " (default with --fast)" if entry.name == quick else ""
        reached = [key if key in known else "-" for key in (entry.name, QPSOLVERS + entry.name)]
        rows.append((name, *reached, entry.name if entry.name in native else "-", entry.method))
    rows.append((NONE, "-", "-", "-", "exact method from a cold start"))
    shared.print_rows(rows)
    return 0


def fast_default() -> str | None:
    """The backend of `fast` where none is named; None if that folder is not there."""
    try:
        with needing("fast"):
            from quasistatic_ref.optional.fast.backends import DEFAULT_OF_FAST
    except InputError:
        return None
    return DEFAULT_OF_FAST
