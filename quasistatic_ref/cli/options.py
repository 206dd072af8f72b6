"""Options and habits that several commands share."""

from __future__ import annotations

import argparse
import sys
import textwrap
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import RunFailed
from quasistatic_ref.files import json_text
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.cones import CONES
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.files import step_read, step_written


def add_out(parser: argparse.ArgumentParser, default: str) -> None:
    """``--out FOLDER``."""
    parser.add_argument(
        "--out", type=Path, default=Path(default), metavar="FOLDER", help="folder for the results"
    )


def add_solver(parser: argparse.ArgumentParser) -> None:
    """``--backend``, ``--engine``, ``--cone`` and ``--certify``."""
    parser.add_argument("--backend", metavar="NAME", help="solver; see 'quasistatic-ref backends'")
    parser.add_argument("--engine", metavar="NAME", help="native or cvxpy: how it is asked")
    add_cone(parser)
    parser.add_argument("--certify", metavar="KIND", help="full (default), residual or off")


def add_cone(parser: argparse.ArgumentParser) -> None:
    """``--cone``."""
    parser.add_argument(
        "--cone", metavar="NAME", help=f"friction cone in place of the file's: {', '.join(CONES)}"
    )


def add_json(parser: argparse.ArgumentParser) -> None:
    """``--json``."""
    parser.add_argument("--json", action="store_true", help="print one JSON object, nothing else")


def add_quiet(parser: argparse.ArgumentParser) -> None:
    """``--quiet``."""
    parser.add_argument("--quiet", action="store_true", help="show no progress")


def progress_line(options: argparse.Namespace, line: str) -> None:
    """Print one line of progress on standard error, unless ``--quiet`` was given."""
    if not options.quiet:
        print(line, file=sys.stderr)


def add_set(parser: argparse.ArgumentParser) -> None:
    """``--set key=value``."""
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        dest="settings",
        help="change a field of the scenario, e.g. contacts.grip.mu_omega=0",
    )


def scenario_settings(options: argparse.Namespace) -> list[str]:
    """``--set`` and the options of :func:`add_solver` as changes of a scenario."""
    settings: list[str] = list(getattr(options, "settings", []))
    for key in ("backend", "engine", "certify"):
        value = getattr(options, key, None)
        if value is not None:
            settings.append(f"solver.{key}={json_text(value)}")
    if getattr(options, "cone", None) is not None:
        settings.append(f"cone={json_text(options.cone)}")
    return settings


def step_given(options: argparse.Namespace) -> StepData:
    """The step file of a command, in the cone of ``--cone`` where that is given."""
    step = step_read(options.step)
    return step if options.cone is None else step.replace(cone=options.cone)


def print_json(value: Any) -> None:
    """Print one JSON object on standard output."""
    print(json_text(value))


WIDTH = 120
"""Columns of a terminal within which sentences are broken."""


def print_rows(rows: list[tuple[str, ...]], notes: Sequence[str] = ()) -> None:
    """Print a table, the first column to the left, the others to the right.

    Parameters
    ----------
    rows : list of tuple of str
        The first holds the names of the columns.
    notes : sequence of str, optional
        Words below each row after the first, such as are too long for a column.
    """
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row, note in zip_longest(rows, ["", *notes], fillvalue=""):
        first, *rest = (cell.ljust(w) if i == 0 else cell.rjust(w)
                        for i, (cell, w) in enumerate(zip(row, widths, strict=True)))  # fmt: skip
        print("  ".join([first, *rest]).rstrip())
        print_wrapped(note, "    ")


def print_wrapped(words: str, indent: str = "", first: str | None = None) -> None:
    """Print words in lines of at most `WIDTH` columns; nothing for no words."""
    begin = indent if first is None else first
    lines = textwrap.wrap(words, WIDTH, initial_indent=begin, subsequent_indent=indent,
                          break_long_words=False, break_on_hyphens=False)  # fmt: skip
    for line in lines:
        print(line)


def failed_run_saved(failure: RunFailed, folder: Path, stem: str) -> int:
    """Write what a failed run left, its steps and the failing one; say why, return the status."""
    trajectory: Trajectory = failure.trajectory
    interrupted = isinstance(failure.__cause__, KeyboardInterrupt)
    for sentence in () if interrupted else trajectory.warnings:
        print(f"quasistatic-ref: {sentence}", file=sys.stderr)
    path = trajectory.save(folder / f"{stem}.npz")
    kept = f"the first {trajectory.steps} steps are in {path}"
    if failure.step is not None:
        step = step_written(folder / f"{stem}_failed_step.json", failure.step)
        kept += f", the failing step in {step}"
    print(f"quasistatic-ref: {failure.reason}; {kept}", file=sys.stderr)
    return 130 if interrupted else 3
