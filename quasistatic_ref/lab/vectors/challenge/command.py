"""What ``vectors challenge`` does, once its options are read."""

import argparse
import sys

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.challenge.finding import FORMAT
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.run import Outcome, asked_again, challenge
from quasistatic_ref.lab.vectors.check.verdict import DIGITS
from quasistatic_ref.text.content import json_read


def challenge_status(options: argparse.Namespace) -> int:
    """Ask one case again, or challenge; the exit status.

    Raises
    ------
    InputError
        Of options that cannot be, and of a program that does not start.
    """
    if options.program is None:
        raise InputError("is missing; name the program that is challenged", field="--command")
    for name in ("cases", "seconds", "timeout", "digits"):
        value = getattr(options, name)
        if value is not None and not 0 < value < float("inf"):
            raise InputError("must be positive", field=f"--{name}", value=value)
    if options.seed < 0:
        raise InputError("must be 0 or more", field="--seed", value=options.seed)
    if options.digits is not None and options.digits > DIGITS:
        raise InputError(f"must be at most {DIGITS:g}", field="--digits", value=options.digits)
    program = Program(options.program, options.timeout)
    if options.again is not None:
        record = json_read(options.again)
        if not isinstance(record, dict) or record.get("format") != FORMAT:
            raise InputError(
                "is not a counterexample; name one that a challenge wrote", file=options.again
            )
        outcome = asked_again(program, record, options.digits)
    else:
        outcome = challenge(
            program,
            layers=options.layers,
            cases=options.cases,
            seconds=options.seconds,
            seed=options.seed,
            digits=options.digits,
            report=lambda line: None if options.quiet else print(line, file=sys.stderr, flush=True),
        )
    _print_outcome(outcome, options)
    return outcome.status


def _print_outcome(outcome: Outcome, options: argparse.Namespace) -> None:
    """Print the outcome of a challenge, and write its counterexamples."""
    written = [] if options.again else [
        finding.write_folder(options.out, options.program) for finding in outcome.findings
    ]  # fmt: skip
    if options.json:
        shared.print_json(
            {
                "implementation": outcome.implementation,
                "findings": [finding.record for finding in outcome.findings],
                "remark": outcome.remark,
                "not_asked": outcome.not_asked,
            }
        )
        return
    shared.print_rows(outcome.rows)
    if outcome.not_asked:
        print(outcome.not_asked)
    if options.again or options.quiet:
        for finding in outcome.findings:
            print(f"quasistatic-ref: {finding.title}", file=sys.stderr)
    if outcome.remark:
        print(f"quasistatic-ref: {outcome.remark}", file=sys.stderr)
    for path in written:
        print(path)
