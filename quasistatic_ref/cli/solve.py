"""``solve STEP.json``: solve one step file."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.files import text_written
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solve import CERTIFY, solve_step
from quasistatic_ref.step.files import solution_text, step_read


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("step", type=Path, help="a step file (quasistatic-ref/step)")
    parser.add_argument(
        "-o", type=Path, metavar="SOLUTION.json", dest="output", help="standard output otherwise"
    )
    shared.add_solver(parser)


def run(options: argparse.Namespace) -> int:
    """Solve it and write the solution file; a word on the certificate goes to standard error."""
    step = step_read(options.step)
    certify = options.certify or CERTIFY[0]
    solution = solve_step(step, options.backend or DEFAULT, certify=certify)
    text = solution_text(step, solution)
    if options.output is None:
        sys.stdout.write(text)
    else:
        text_written(options.output, text)
    worst = max(solution.certificate.residuals.values(), default=None)
    told = (
        "nothing was certified" if worst is None else f"worst residual {worst:.1e} in natural units"
    )
    print(f"{solution.backend}: {solution.status}; {told}", file=sys.stderr)
    return 0
