"""``stands SCENE``: which bodies stand after the steps of a run, and what others lack.

Exit status 0; with ``--strict`` 1 if a body lacks something; 3 if a step has no solution.
"""

import argparse
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.run import scenario_of
from quasistatic_ref.errors import InputError
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import listed
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.standing import NOTHING_FREE, WORDS, Standing, Standings
from quasistatic_ref.text.plain import field_values


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.epilog = (
        "exit status: 0, or with --strict 1 if a body does not stand; 3 if a step has no solution"
    )
    parser.add_argument("scenario", help="a scenario or a MuJoCo scene, as run takes it")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--at", type=float, metavar="T", help="after the step that ends at T [s]")
    which.add_argument(
        "--every", type=int, default=1, metavar="N", help="after every N-th step, and the last"
    )
    parser.add_argument("--targets", metavar="FILE.csv|KEY,KEY,...", help="as run takes them")
    parser.add_argument("--keyframe", metavar="KEY", help="keyframe in which a MuJoCo scene starts")
    parser.add_argument(
        "--strict", action="store_true", help="end with status 1 if a body does not stand"
    )
    parser.add_argument(
        "--certify", metavar="KIND", help="full: prove the ends of all iterations (default: off)"
    )
    shared.add(parser, "--backend", "--fast", "--cone", "--law", "--set", "--root", "--json")


def run(options: argparse.Namespace) -> int:
    """Run the scene, ask after its steps, and print a row a body."""
    part("stands")  # or its sentence
    shared.check_at_least_one(options, "every")
    scenario = scenario_of(options)
    if options.at is not None:  # what comes after is not asked
        (last,) = asked_steps(scenario.steps, scenario.h, options.at)
        scenario = scenario.with_fields(steps=last + 1)
    failure = None
    try:
        trajectory = scenario.run(progress=not options.quiet, findings=False)
    except RunFailed as failed:
        failure = failed
        trajectory = failed.trajectory
    steps = asked_steps(trajectory.steps, scenario.h, options.at, options.every)
    bar = progress_bar(steps, unit="step", words="stands", shown=not options.quiet)
    certify = options.certify or "off"
    answers = {k: trajectory.stands(k, scenario, certify=certify) for k in bar}
    rows = [*map(over_steps, zip(*_by_step(answers), strict=True))]
    cone = next(iter(answers.values())).cone if answers else scenario.cone
    if options.json:
        shared.print_json({"cone": cone, "steps": steps, "bodies": rows})
    elif rows:
        head = ("body", "stands", "since step", f"most missing, in the {cone}", "at step")
        shared.print_rows([head, *map(_cells, rows)], [*map(_note, rows)])
    else:
        print(NOTHING_FREE if answers else "no step has ended")
    if failure is not None:
        print(f"quasistatic-ref: {failure.reason}", file=sys.stderr)
        return 3
    return int(options.strict and any(row["stands"] is False for row in rows))


def asked_steps(steps: int, h: float, at: float | None, every: int = 1) -> list[int]:
    """The steps that are asked: the one that ends at a time [s], or every so manyth and the last.

    Parameters
    ----------
    steps : int
        Of the run.
    h : float
        [s].
    at, every
        As above.

    Raises
    ------
    InputError
        If no step ends there.
    """
    if at is None:
        return sorted({*range(every - 1, steps, every), steps - 1} - {-1})
    k = round(at / h) - 1 if abs(at) < math.inf else -1
    if not 0 <= k < steps:
        problem = f"must be the end of a step, up to {steps * h:g} s"
        raise InputError(problem, field="--at", value=at)
    return [k]


def _by_step(answers: Mapping[int, Standings]) -> Iterator[list[tuple[int, Standing]]]:
    for k, standings in answers.items():
        yield [(k, row) for row in standings]


def over_steps(rows: Sequence[tuple[int, Standing]]) -> dict[str, Any]:
    """One row for a body, made of its rows in all steps that were asked.

    Where it lacks something in any step it does not stand: since the first of these, and as far as
    it lacks most.

    Parameters
    ----------
    rows : sequence of (int, Standing)
        Of one body, each with the number of its step.
    """
    lacks = [row for row in rows if row[1].stands is False]
    known = [row for row in rows if row[1].stands is None] or rows
    k, most = max(lacks or known, key=lambda row: (row[1].missing_N, row[1].missing_Nm))
    since = lacks[0][0] if lacks else None
    asked, failed = len(rows), len(lacks)
    return {**field_values(most), "since": since, "step": k, "asked": asked, "lacks": failed}


def _cells(row: Mapping[str, Any]) -> tuple[str, ...]:
    of = f"{WORDS[row['stands']]}, in {row['lacks']} of {row['asked']}" if row["lacks"] else ""
    parts = {"N": row["missing_N"], "N m": row["missing_Nm"]}
    missing = " and ".join(f"{x:.4g} {unit}" for unit, x in parts.items() if x)
    since = "" if row["since"] is None else str(row["since"])
    return (
        row["body"],
        of or WORDS[row["stands"]],
        since,
        missing,
        str(row["step"]) if missing else "",
    )


def _note(row: Mapping[str, Any]) -> str:
    with_it = f"with {listed(row['held_with'])}" if row["held_with"] else ""
    reason = f"step {row['step']}: {row['reason']}" if row["reason"] else ""
    return "; ".join(filter(None, (with_it, reason)))
