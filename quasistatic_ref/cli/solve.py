"""``solve STEP.json``: solve one step file."""

import argparse
import sys
from fractions import Fraction
from pathlib import Path

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.groups import flat_rows
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.certificate_words import in_words
from quasistatic_ref.cli.decimals import decimal_string
from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.working_set import fraction_point
from quasistatic_ref.files.solution import infeasible_text, solution_text
from quasistatic_ref.solve.backends import CERTIFY, DAQP
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.text.content import text_written


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "step")
    shared.add(parser, "-o", metavar="SOLUTION.json")
    parser.add_argument(
        "--digits",
        type=int,
        metavar="N",
        help="print delta_q in N decimal digits; the solution file is then written with -o only",
    )
    shared.add(parser, *shared.SOLVER)


def run(options: argparse.Namespace) -> int:
    """Solve a step file, write the solution, and print its certificate on standard error.

    An infeasible step gets a solution file too, with the proof, and exit status 3.

    Raises
    ------
    InputError
        If files or options do not go together.
    """
    certify = CERTIFY[0] if options.certify is None else options.certify
    step = shared.step_of(options)
    if options.digits is not None:
        _check_digits(options.digits, certify, step)
    try:
        quick = options.backend is None and options.fast and cone(step.cone).polyhedral
        solver = solver_for(step, DAQP if quick else options.backend)
        solution = solve_step(step, solver, certify=certify)
    except StepInfeasible as proof:
        _write(options.output, infeasible_text(step, proof.farkas.exact))
        raise
    if options.digits is not None:
        shared.print_rows(decimals(solution, options.digits))
    if options.digits is None or options.output is not None:
        _write(options.output, solution_text(solution))
    digits = solution.statistics.digits
    solver_digits = "" if digits is None else f" ({solver.name} had {digits:.1f} correct digits)"
    print(f"{in_words(solution.certificate)}{solver_digits}", file=sys.stderr)
    return 0


def _check_digits(digits: int, certify: str, step: StepData) -> None:
    if digits < 1:
        problem = "must be at least 1"
    elif certify != CERTIFY[0]:
        problem = f"needs the exact optimum; leave out --certify {certify}"
    elif not cone(step.cone).polyhedral:
        problem = "needs a polyhedral cone: the optimum in the ellipsoid is no fraction"
    else:
        return
    raise InputError(problem, field="--digits", value=digits)


def decimals(solution: StepSolution, digits: int) -> list[tuple[str, ...]]:
    """Each delta_q in decimal digits [m, rad], correctly rounded from the exact optimum."""
    step = solution.step
    working = flat_rows(step, solution.certificate.active)
    names = [f"delta_q_a[{i}]" for i in range(step.n_a)]
    names += [f"delta_q_u[{i}]" for i in range(step.n_u)]
    exact = fraction_point(StepProgram(step), working).exact_x
    values = [decimal_string(Fraction(int(v.p), int(v.q)), digits) for v in exact]
    return list(zip(names, values, strict=True))


def _write(output: Path | None, text: str) -> None:
    if output is None:
        sys.stdout.write(text)
    else:
        text_written(output, text)
