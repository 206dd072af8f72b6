"""``verify STEP.json SOLUTION.json``: re-check an answer, and its certificate, without a solver."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from quasistatic_ref.certify.certificate import in_words, verify
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.cli import options as shared
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.files import step_sha256
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.solution_files import SolutionFile, solution_read
from quasistatic_ref.tolerances import WRENCH


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("step", type=Path, help="a step file (quasistatic-ref/step)")
    parser.add_argument("solution", type=Path, help="a solution file (quasistatic-ref/solution)")
    shared.add(parser, "--cone", "--json")


def run(options: argparse.Namespace) -> int:
    """Exit status 0 if the certificate holds, 1 if it does not."""
    step = shared.step_given(options)
    solution = solution_read(options.solution, step)
    reason = refutation(step, solution)
    if options.json:
        shared.print_json({"verified": reason is None, "reason": reason})
    elif reason is not None:
        print(f"refuted: {reason}")
    elif solution.certificate is None:
        print("verified: the step has no solution; the Farkas vector proves it")
    else:
        print(f"verified: {in_words(step, solution.certificate)}")
    return 0 if reason is None else 1


def refutation(step: StepData, solution: SolutionFile) -> str | None:
    """What is wrong with a solution; None if all that it claims is proved."""
    if solution.step_sha256 != step_sha256(step):
        return "the solution belongs to another step: step_sha256 differs"
    if solution.farkas is not None:
        return farkas_refutation(step, solution.farkas)
    certificate, delta_q, lam = solution.certificate, solution.delta_q, solution.lam
    assert certificate is not None
    assert delta_q is not None
    assert lam is not None
    if certificate.kind not in ("exact", "enclosure"):
        return f"a certificate of kind {certificate.kind!r} proves nothing; solve with full"
    verdict = verify(step, delta_q, certificate.active, lam, certificate)
    if not verdict:
        return verdict.reason
    m = int(step.offsets[-1])
    wrench = contact_wrenches(step.contacts, lam[:m], step.h, step.cone)
    scale = float(np.abs(wrench).max(initial=0.0))
    if solution.wrench is None or np.abs(solution.wrench - wrench).max(initial=0) > WRENCH * scale:
        return "the wrenches are not the combination of lam"
    return None
