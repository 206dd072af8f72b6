"""``extract TRAJECTORY.npz --step K -o STEP.json``: one step of a trajectory as a step file."""

import argparse
import sys
from pathlib import Path

from quasistatic_ref.errors import about_file
from quasistatic_ref.simulate.trajectory import load_trajectory
from quasistatic_ref.step.files import save_step, step_text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("trajectory", type=Path, help="a trajectory file (.npz)")
    parser.add_argument("--step", type=int, required=True, metavar="K", help="counted from 0")
    parser.add_argument(
        "-o", type=Path, metavar="STEP.json", dest="output", help="standard output otherwise"
    )


def run(options: argparse.Namespace) -> int:
    """Write the step, bit for bit as it was solved."""
    trajectory = load_trajectory(options.trajectory)
    with about_file(options.trajectory):
        step = trajectory.step_data(options.step)
    if options.output is None:
        sys.stdout.write(step_text(step))
    else:
        print(f"wrote {save_step(options.output, step)}")
    return 0
