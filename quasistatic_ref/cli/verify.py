"""``verify STEP.json SOLUTION.json``: re-check an answer, and its certificate, without a solver."""

import argparse
from pathlib import Path

from quasistatic_ref.certify.solution_files import load_solution
from quasistatic_ref.certify.verification import verify
from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.certificate_words import in_words


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "step")
    parser.add_argument("solution", type=Path, help="a solution file (quasistatic-ref/solution)")
    shared.add(parser, "--cone", "--json")


def run(options: argparse.Namespace) -> int:
    """Exit status 0 if all that is claimed holds, 1 if it does not."""
    step = shared.step_of(options)
    solution = load_solution(options.solution, step)
    verdict = verify(solution)
    if options.json:
        shared.print_json({"verified": verdict.ok, "reason": verdict.reason or None})
    elif not verdict:
        print(f"refuted: {verdict.reason}")
    else:
        proved = "the step has no solution; the Farkas vector proves it"
        if solution.certificate is not None:
            proved = in_words(solution.certificate)
        print(f"verified: {proved}")
    return 0 if verdict else 1
