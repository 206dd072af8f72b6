"""``qp FILE``: the exact answer of a quadratic program, and what solvers make of it."""

import argparse
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.exact.qp.answer import Answer, ExactQP, NoOptimum
from quasistatic_ref.exact.qp.exact import exact_qp
from quasistatic_ref.exact.qp.program import QuadraticProgram
from quasistatic_ref.exact.time_limit import TimeIsUp
from quasistatic_ref.lab.study.problems.names import NATURAL, RAW
from quasistatic_ref.optional.qp_files.load import READERS, file_programs
from quasistatic_ref.quoting import listed, one_line

if TYPE_CHECKING:
    from quasistatic_ref.lab.study.row import Row

SETTINGS = ("default", "high")
"""The accuracies that solvers are asked for: their own, and 1e-9."""
HEADS = {
    RAW: "solvers get the file's numbers; primal, dual and gap are in natural units",
    NATURAL: "solvers get the program in natural units, in which primal, dual and gap are, too",
}
MOST_NAMES = 20
"""Active rows that a line names."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    words = f"a file of a program, {listed([*READERS])}, or a folder of such, which is a study"
    parser.add_argument("file", type=Path, help=words)
    parser.add_argument(
        "--solvers",
        nargs="+",
        metavar="NAME",
        help="solvers of qpsolvers, or cvxpy:NAME (default for a folder: all that are installed)",
    )
    parser.add_argument(
        "--units",
        choices=(RAW, NATURAL),
        default=RAW,
        help="in which solvers get the program: raw, the file's numbers (default), or natural, "
        "powers of two of these that are near one",
    )
    parser.add_argument(
        "--seconds",
        type=float,
        help="for the proof of a program; one that takes longer is left out",
    )
    shared.add(parser, "-o", metavar="ANSWER.json")
    shared.add(parser, "--out", default="study")


def run(options: argparse.Namespace) -> int:
    """Exit status 0 if all have an optimum, 3 if the program of a file has none.

    Raises
    ------
    InputError
        If a file cannot be used.
    """
    if options.file.is_dir():
        return _study(options)
    with about_file(options.file):
        programs = _loaded(options.file)
        answers = {name: _answer(p, options.seconds) for name, p in programs.items()}
    for name, answer in answers.items():
        print(one_line(f"{name}: {_in_words(answer)}"))
    if options.output is not None:
        if len(answers) > 1:
            raise InputError("holds several programs; -o writes one", file=options.file)
        for answer in answers.values():
            if not isinstance(answer, TimeIsUp):
                print(f"wrote {answer.save(options.output)}")
    if options.solvers:
        from quasistatic_ref.lab.study.foreign import known, rows_of

        if known(answers):
            rows = rows_of(answers, _labels(options.solvers), SETTINGS, options.units)
            print(HEADS[options.units])
            shared.print_rows(_table(rows))
    return 0 if all(isinstance(answer, ExactQP) for answer in answers.values()) else 3


def _study(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.foreign import known
    from quasistatic_ref.lab.study.run import study
    from quasistatic_ref.lab.study.store import ROWS

    answers: dict[str, Answer | TimeIsUp] = {}
    for path in sorted(options.file.iterdir()):
        if path.suffix.lower() not in READERS:
            continue
        try:
            for name, program in _loaded(path).items():
                answers[name] = _answer(program, options.seconds)
        except InputError as error:  # the others are a study all the same
            print(f"{path.name}: left out: {error}")
    for name, answer in answers.items():
        print(one_line(f"{name}: {_in_words(answer)}"))
    if not known(answers):
        problem = "holds no program with an optimum, or proved to have no solution"
        raise InputError(problem, file=options.file)
    labels = _labels(options.solvers or ["*"])
    units = (options.units,)
    progress = not options.quiet
    study(known(answers), labels, SETTINGS, options.out, units=units, progress=progress)
    print(
        f"wrote {Path(options.out) / ROWS}; 'quasistatic-ref study report {options.out}' tables it"
    )
    return 0


def _loaded(path: Path) -> dict[str, QuadraticProgram]:
    """The programs of a file; what its reader warns of is printed."""
    with warnings.catch_warnings(record=True) as remarks:
        warnings.simplefilter("always")
        programs = file_programs(path)
    for remark in remarks:
        print(f"quasistatic-ref: {path}: {remark.message}", file=sys.stderr)
    return programs


def _answer(program: QuadraticProgram, seconds: float | None) -> Answer | TimeIsUp:
    try:
        with warnings.catch_warnings(action="ignore"):  # a remark is printed
            return exact_qp(program, seconds=seconds)
    except (NoOptimum, TimeIsUp) as end:
        return end


def _labels(names: list[str]) -> list[str]:
    return [name if ":" in name else f"qpsolvers:{name}" for name in names]


def _in_words(answer: Answer | TimeIsUp) -> str:
    if not isinstance(answer, ExactQP):
        return str(answer)
    names = answer.active
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    active = f"{', '.join(names[:MOST_NAMES])}{more}" if names else "none"
    x, multipliers = (
        "unique" if only else "not unique" for only in (answer.x_unique, answer.multipliers_unique)
    )
    remark = f"; {answer.remark}" if answer.remark else ""
    proved = f"proved: objective {answer.obj!r}; active: {active}"
    return f"{proved}; x {x}; multipliers {multipliers}{remark}"


def _table(rows: list["Row"]) -> list[tuple[str, ...]]:
    """A line for each call: what the solver says, its residuals, digits and seconds."""
    head = ("solver", "accuracy", "says", "primal", "dual", "gap", "reached", "digits", "seconds")
    lines: list[tuple[str, ...]] = [head]
    for row in rows:
        numbers = [row.accuracy, row.primal, row.dual, row.gap]
        accuracy, *residuals = ("-" if v is None else f"{v:.0e}" for v in numbers)
        digits = "-" if row.digits is None else f"{row.digits:.1f}"
        seconds = "-" if row.seconds is None else f"{row.seconds:.2g}"
        reached = {True: "yes", False: "no", None: "-"}[row.reached]
        name = f"{row.door}:{row.solver}"
        lines.append((name, accuracy, row.says, *residuals, reached, digits, seconds))
    return lines
