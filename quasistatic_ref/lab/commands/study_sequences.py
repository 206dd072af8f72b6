"""``study sequences``: solvers on steps in order, from cold and from what the step before left."""

import argparse
import csv
import io
import sys
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError

MODES = ("cold", "updates", "primal", "primal-dual", "active set")
"""As in lab/study/measuring/sequences.py, which is slow to import; a test holds them equal."""

WARM_UP = 10.0
"""Of a call at a sequence's beginning [s]."""
LONGEST = 1e6
"""Largest limit; an operating system waits for 2^31 ms."""
ORDINARY = ("solved", "failed")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare solvers, modes and sequences."""
    words = "daqp, osqp, ...: natively; qpsolvers:NAME; package:NAME; or module:function"
    parser.add_argument("solvers", nargs="+", metavar="SOLVER", help=words)
    parser.add_argument(
        "--modes", metavar="MODE,...", help=f"of {', '.join(MODES)}; else all that each can"
    )
    parser.add_argument("--scenario", metavar="NAME", help="only sequences of this scenario")
    words = "steps from one problem to the next: 1 (default), 4 or 16"
    parser.add_argument("--stride", type=int, default=1, metavar="N", help=words)
    words = "that the solvers are set to, in natural units (1e-9)"
    parser.add_argument("--accuracy", type=float, default=1e-9, metavar="EPS", help=words)
    words = "of each sequence, whose times are medians (5)"
    parser.add_argument("--repetitions", type=int, default=5, metavar="N", help=words)
    for name, value, words in (
        ("--time-limit", 2.0, "seconds of a call; at a sequence's beginning 10"),
        ("--memory", 4.0, "GB of a solver's processes"),
        ("--budget", 600.0, "seconds of all calls of a solver"),
    ):
        parser.add_argument(
            name, type=float, default=value, metavar="LIMIT", help=f"{words} ({value:g})"
        )
    shared.add(parser, "--out", default=None)
    shared.add(parser, "--json")


def run_sequences(options: argparse.Namespace) -> int:
    """Run solvers; print a line for each solver and mode. InputError if that is not possible."""
    from quasistatic_ref.formats.files import text_written
    from quasistatic_ref.formats.resources import problem_set_folder
    from quasistatic_ref.lab.study.measuring.sequences import (
        SequenceRow,
        SolverLimits,
        checked,
        sequence_rows,
    )
    from quasistatic_ref.lab.study.problems.folder import set_read
    from quasistatic_ref.lab.study.problems.problem import Member
    from quasistatic_ref.simulate.progress import progress_bar

    if options.repetitions < 1:
        raise InputError("must be at least 1", field="--repetitions", value=options.repetitions)
    if not 0 < options.accuracy < 1:
        raise InputError("must be between 0 and 1", field="--accuracy", value=options.accuracy)
    for name in ("time_limit", "memory", "budget"):
        if not 0 < (value := getattr(options, name)) < LONGEST:
            words = f"must be above 0 and below {LONGEST:g}"
            raise InputError(words, field=f"--{name.replace('_', '-')}", value=value)
    limits = SolverLimits(options.time_limit, max(WARM_UP, options.time_limit),
                          options.repetitions, 1e9 * options.memory, options.budget)  # fmt: skip
    modes = checked(options.solvers, options.modes.split(",") if options.modes else None)
    sequences: dict[str, list[Member]] = defaultdict(list)
    for one in set_read(problem_set_folder(), ["sequences"]):
        name = one.facts["sequence"]["name"]
        wanted = options.scenario in (None, name.partition("/")[0])
        if wanted and one.facts["dial"] == options.stride:
            sequences[name].append(one)
    if not sequences:
        raise InputError("have no such sequence", field="--scenario and --stride",
                         value=[options.scenario, options.stride])  # fmt: skip
    total = sum(map(len, sequences.values())) * sum(map(len, modes.values()))
    rows: list[SequenceRow] = []
    with progress_bar(
        total=total, unit="problem", words="calls made", shown=not options.quiet
    ) as bar:
        for row in sequence_rows(sequences, modes, options.accuracy, limits):
            rows.append(row)
            bar.update()
    if options.out is not None:
        path = text_written(options.out / "sequences.csv", _table(rows))
        print(f"wrote {path}", file=sys.stderr if options.json else sys.stdout)
    if options.json:
        shared.print_json([asdict(row) for row in rows])
        return 0
    shared.print_rows(_summary(rows, modes))
    ends = Counter((r.solver, r.mode, r.outcome) for r in rows if r.outcome not in ORDINARY)
    for (solver, mode, outcome), count in ends.items():
        print(f"{solver}, {mode}: {count} {outcome.replace('_', ' ')}")
    return 0


def _summary(rows: list[Any], modes: Mapping[str, Sequence[str]]) -> list[tuple[str, ...]]:
    """One line a solver and mode, of all problems but the first of each sequence."""
    heading = ("solver", "mode", "problems", "solved", "digits, worst", "iterations, median",
               "time, median [ms]", "over cold")  # fmt: skip
    table: list[tuple[str, ...]] = [heading]
    for solver, own in modes.items():
        cost = {}
        for mode in own:
            some = [r for r in rows if (r.solver, r.mode) == (solver, mode) and r.place > 0]
            counts = [r.iterations for r in some if r.iterations is not None]
            cost[mode] = 1e3 * float(np.median([r.seconds for r in some]))
            over = f"{cost[mode] / cost['cold']:.2f}" if "cold" in cost else "-"
            table.append((
                solver, mode, str(len(some)), str(sum(r.solved for r in some)),
                f"{min(r.digits for r in some):.1f}",
                f"{np.median(counts):g}" if counts else "-", f"{cost[mode]:.3g}", over,
            ))  # fmt: skip
    return table


def _table(rows: list[Any]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(asdict(rows[0])), lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(row) for row in rows)
    return text.getvalue()
