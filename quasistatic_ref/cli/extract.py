"""``extract TRAJECTORY.npz --step K -o STEP.json``: one step of a trajectory as a step file."""

import argparse
import sys
from pathlib import Path

from quasistatic_ref.certify.groups import group_step, groups
from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.files.step import save_step
from quasistatic_ref.files.trajectory import load_trajectory
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.step.text import step_text
from quasistatic_ref.text.content import LARGEST_TEXT

OF_ENTRY = 5
"""Bytes of an entry that is zero, as nearly all are in a large step."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("trajectory", type=Path, help="a trajectory file (.npz)")
    parser.add_argument(
        "--step", type=int, required=True, metavar="K", help="number of the step, counted from 0"
    )
    parser.add_argument(
        "--body",
        metavar="NAME",
        help="write only the part of the step that is coupled to this body",
    )
    shared.add(parser, "-o", metavar="STEP.json")


def run(options: argparse.Namespace) -> int:
    """Write one step of a run as a step file, bit for bit as it was solved.

    Raises
    ------
    InputError
        If there is no such step or body, or all of it is too large for a step file.
    """
    trajectory = load_trajectory(options.trajectory)
    with about_file(options.trajectory):
        bodies = [name.partition("/")[0] for name in trajectory.header.coordinates]
        body = options.body
        if body is None:
            _check_size(len(bodies), trajectory["rows"].size)
        elif body not in bodies:
            problem = f"is not a body that moves{suggestion(body, {*bodies})}"
            raise InputError(problem, field="--body", value=body)
        step = trajectory.step_data(options.step)
        if body is not None:
            first = bodies.index(body)
            step = group_step(step, next(one for one in groups(step) if first in one.coordinates))
    if options.output is None:
        sys.stdout.write(step_text(step))
    else:
        print(f"wrote {save_step(options.output, step)}")
    return 0


def _check_size(n_v: int, n_c: int) -> None:
    """Refuse to write a step file that is too large to be read again."""
    if OF_ENTRY * n_v * (n_v + 4 * n_c) > LARGEST_TEXT:
        problem = "is too large for a step file; extract the group of one body, with --body"
        raise InputError(problem, field="step")
