"""Options and habits that several commands share."""

import argparse
import os
import shlex
import sys
import textwrap
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.option_change import OptionChange
from quasistatic_ref.files.step import load_step, save_step
from quasistatic_ref.quoting import aligned
from quasistatic_ref.simulate.interrupt import exit_status
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.step.cones import CONES
from quasistatic_ref.step.data import StepData
from quasistatic_ref.text.json_text import json_text

OPTIONS: Final[dict[str, dict[str, Any]]] = {
    "step": {"type": Path, "help": "a step file (quasistatic-ref/step)"},
    "-o": {"type": Path, "dest": "output", "help": "file to write (default: print)"},
    "--out": {"type": Path, "metavar": "FOLDER", "help": "folder for the results"},
    "--backend": {
        "metavar": "NAME",
        "help": "solver of the steps; 'quasistatic-ref backends' lists them",
    },
    "--fast": {
        "action": "store_true",
        "help": "--backend daqp: sooner, with the same bits of q, delta_q, A'lam if certified",
    },
    "--cone": {
        "metavar": "NAME",
        "help": f"friction cone in place of the file's: {', '.join(CONES)}",
    },
    "--law": {
        "metavar": "NAME",
        "help": "law of friction: convex (the model's; default), or coulomb, under which sliding "
        "contacts do not lift off",
    },
    "--certify": {
        "metavar": "KIND",
        "help": "what is proved of each step: full (the exact optimum; default), "
        "residual (Eqs. (9)-(12) in float64) or off",
    },
    "--set": {
        "action": "append",
        "default": [],
        "metavar": "KEY=VALUE",
        "dest": "settings",
        "help": "change a field of the scenario, e.g. contacts.grip.mu_omega=0",
    },
    "--root": {
        "action": "append",
        "default": [],
        "metavar": "FOLDER",
        "dest": "roots",
        "help": "another folder in which robots and package:// paths are looked for",
    },
    "--ignore": {
        "action": "append",
        "default": [],
        "metavar": "NAME",
        "help": "do not print findings of this name, and do not count them for --strict; "
        "NAME,NAME names several",
    },
    "--json": {"action": "store_true", "help": "print one JSON object and nothing else"},
}
SOLVER: Final = ("--backend", "--fast", "--cone", "--certify")

if TYPE_CHECKING:
    from quasistatic_ref.simulate.record.trajectory import Trajectory


def add(parser: argparse.ArgumentParser, *names: str, **more: Any) -> None:
    """Declare some of `OPTIONS`, perhaps with a default, which the help then names."""
    for name in names:
        settings = OPTIONS[name] | more
        if "default" in more:
            settings["help"] += f" (default: {more['default']})"
        parser.add_argument(name, **settings)


def check_at_least_one(options: argparse.Namespace, name: str) -> None:
    """Refuse a value below 1 of an option that counts something.

    Raises
    ------
    InputError
        If it is.
    """
    value: int | None = getattr(options, name)
    if value is not None and value < 1:
        raise InputError("must be at least 1", field=f"--{name}", value=value)


def progress_line(options: argparse.Namespace, line: str, end: str = "\n") -> None:
    """Print one line of progress on standard error, unless ``--quiet`` was given."""
    if not options.quiet:
        print(line, end=end, file=sys.stderr, flush=True)


def scenario_settings(options: argparse.Namespace) -> list[str]:
    """``--set``, ``--root`` and the options of ``SOLVER`` as changes of a scenario."""
    settings: list[str] = list(getattr(options, "settings", []))
    for name in ("solver.backend", "solver.certify", "fast", "cone", "law"):
        word = name.removeprefix("solver.")
        value = getattr(options, word, None)
        if value is not None and value is not False:  # a flag that is not given
            written = f"--{word}" if value is True else f"--{word} {shlex.quote(value)}"
            settings.append(OptionChange(f"{name}={json_text(value)}", written))
    if words := getattr(options, "ignore", []):
        names = [name for word in words for name in word.split(",")]
        written = " ".join(f"--ignore {shlex.quote(word)}" for word in words)
        settings.append(OptionChange(f"findings.ignore={json_text(names)}", written))
    if roots := getattr(options, "roots", []):
        folders = json_text([os.path.abspath(root) for root in roots])
        written = " ".join(f"--root {shlex.quote(str(root))}" for root in roots)
        settings.append(OptionChange(f"roots={folders}", written))
    return settings


def step_of(options: argparse.Namespace) -> StepData:
    """The step of a command's file, in the cone of ``--cone`` if the option was used."""
    step = load_step(options.step)
    return step if options.cone is None else step.replace(cone=options.cone)


def print_json(value: object) -> None:
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
    for line, note in zip_longest(aligned(rows), ["", *notes], fillvalue=""):
        print(line)
        print_wrapped(note, "    ")


def print_wrapped(words: str, indent: str = "", first: str | None = None) -> None:
    """Print words in lines of at most `WIDTH` columns; nothing for no words."""
    begin = indent if first is None else first
    lines = textwrap.wrap(words, WIDTH, initial_indent=begin, subsequent_indent=indent,
                          break_long_words=False, break_on_hyphens=False)  # fmt: skip
    for line in lines:
        print(line)


def failed_run(failure: RunFailed, path: Path) -> int:
    """Save the steps of a failed run and its failing step, print where, return the exit status.

    A trajectory that is there stays.
    """
    from quasistatic_ref.files.trajectory import save_trajectory  # which needs pinocchio

    trajectory: Trajectory = failure.trajectory
    file = path.with_name(f"{path.stem}_failed.npz") if path.exists() else path
    steps = trajectory.steps
    first = "the first step is" if steps == 1 else f"the first {steps} steps are"
    kept = f"{first} in {save_trajectory(file, trajectory)}"
    if failure.step is not None:
        step = save_step(path.with_name(f"{path.stem}_failed_step.json"), failure.step)
        kept += f", the failing step in {step}"
    print(f"quasistatic-ref: {failure.reason}; {kept}", file=sys.stderr)
    cause = failure.__cause__
    return exit_status(cause) if isinstance(cause, KeyboardInterrupt) else 3
