"""``verify STEP.json SOLUTION.json``: re-check an answer, and its certificate, without a solver."""

import argparse
from pathlib import Path

from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.solution_files import SolutionFile, load_solution, rounded_wrenches
from quasistatic_ref.certify.verdict import wrong_bits
from quasistatic_ref.certify.verification import verify_answer
from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.certificate_words import in_words
from quasistatic_ref.step.data import StepData

UNPROVED = ("residual", "none")
"""Kinds of certificate that claim nothing which could be proved."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "step")
    parser.add_argument("solution", type=Path, help="a solution file (quasistatic-ref/solution)")
    shared.add(parser, "--cone", "--json")


def run(options: argparse.Namespace) -> int:
    """Exit status 0 if all that is claimed holds, 1 if it does not."""
    step = shared.step_of(options)
    solution = load_solution(options.solution, step)
    reason = refutation(step, solution)
    if options.json:
        shared.print_json({"verified": reason is None, "reason": reason})
    elif reason is not None:
        print(f"refuted: {reason}")
    else:
        proved = "the step has no solution; the Farkas vector proves it"
        if solution.certificate is not None:
            proved = in_words(solution.certificate)
        print(f"verified: {proved}")
    return 0 if reason is None else 1


def refutation(step: StepData, solution: SolutionFile) -> str | None:
    """What is wrong with a solution; None if all that it claims is proved."""
    if solution.farkas is not None:
        return farkas_refutation(step, solution.farkas)
    certificate = solution.certificate
    delta_q = solution.delta_q
    lam = solution.lam
    if certificate is None:
        return "the solution belongs to another step: step_sha256 differs"
    assert delta_q is not None
    assert lam is not None
    assert solution.wrench is not None
    if certificate.kind in UNPROVED:
        return f"a certificate of kind {certificate.kind!r} proves nothing; solve with full"
    right = rounded_wrenches(step.contacts, lam[: step.offsets[-1]], step.h, step.cone)
    for j, (wrench_row, wrench) in enumerate(zip(solution.wrench, right, strict=True)):
        if wrong := wrong_bits(f"wrench[{j}]", wrench_row, wrench):
            return wrong
    verdict = verify_answer(step, delta_q, certificate.active, lam, certificate)
    return None if verdict else verdict.reason
