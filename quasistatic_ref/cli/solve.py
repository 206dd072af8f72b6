"""``solve STEP.json``: solve one step file."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from quasistatic_ref.certify.certificate import in_words
from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import StepInfeasible
from quasistatic_ref.files import text_written
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solve import CERTIFY, solve_step
from quasistatic_ref.step.solution_files import infeasible_text, solution_text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("step", type=Path, help="a step file (quasistatic-ref/step)")
    parser.add_argument(
        "-o", type=Path, metavar="SOLUTION.json", dest="output", help="standard output otherwise"
    )
    shared.add_solver(parser)


def run(options: argparse.Namespace) -> int:
    """Solve it and write the solution file; a word on the certificate goes to standard error.

    An infeasible step gets a solution file too, with the proof, and exit status 3.
    """
    step = shared.step_given(options)
    backend = options.backend or DEFAULT
    try:
        solution = solve_step(step, backend, certify=options.certify or CERTIFY[0])
    except StepInfeasible as proof:
        _write(options.output, infeasible_text(step, backend, proof.farkas.exact))
        raise
    _write(options.output, solution_text(step, solution))
    digits = solution.statistics.digits
    told = "" if digits is None else f" ({backend} had {digits:.1f} correct digits)"
    print(f"{in_words(step, solution.certificate)}{told}", file=sys.stderr)
    return 0


def _write(output: Path | None, text: str) -> None:
    if output is None:
        sys.stdout.write(text)
    else:
        text_written(output, text)
