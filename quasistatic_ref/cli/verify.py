"""``verify STEP.json SOLUTION.json``: re-check an answer, and its certificate, without a solver.

``verify ANSWER.json`` does so with a file of ``exact_qp``, which holds its program, too.
"""

import argparse
from pathlib import Path

from quasistatic_ref.certify.verification import verify
from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.certificate_words import in_words
from quasistatic_ref.errors import InputError
from quasistatic_ref.files.solution import SOLUTION_FORMAT, load_solution
from quasistatic_ref.parts import needing
from quasistatic_ref.step.text import STEP_FORMAT


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "step")
    words = "a solution file (quasistatic-ref/solution); leave it out for a file of exact_qp"
    parser.add_argument("solution", type=Path, nargs="?", help=words)
    shared.add(parser, "--cone", "--json")


def run(options: argparse.Namespace) -> int:
    """Verify a solution file; exit status 0 if all of its claims hold, 1 if not.

    Raises
    ------
    InputError
        If a file is spoilt, or a step or a solution is given alone.
    """
    if options.solution is None:
        with needing("an answer of exact_qp"):
            from quasistatic_ref.exact.qp.files import load_answer
        try:
            answer = load_answer(options.step)
        except InputError as error:
            if error.field == "format" and error.value in (STEP_FORMAT, SOLUTION_FORMAT):
                problem = "is one of two files: give the step file, then its solution file"
                raise InputError(problem, file=options.step) from None
            raise
        verdict = verify(answer)
        proved = "all that it says of its quadratic program is exact"
    else:
        solution = load_solution(options.solution, shared.step_of(options))
        verdict = verify(solution)
        proved = "the step has no solution; the Farkas vector proves it"
        if verdict and solution.certificate is not None:
            proved = in_words(solution.certificate)
    if options.json:
        shared.print_json({"verified": verdict.ok, "reason": verdict.reason or None})
    else:
        print(f"verified: {proved}" if verdict else f"refuted: {verdict.reason}")
    return 0 if verdict else 1
