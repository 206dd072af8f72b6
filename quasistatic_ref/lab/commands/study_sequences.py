"""``study sequences``: solvers on steps in order, from cold and from what the step before left."""

import argparse
import csv
import io
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.store.rows import Row, label_of

MODES = ("cold", "updates", "primal", "primal-dual", "active set")
"""As in lab/study/calling/sessions.py, which is slow to import; a test holds them equal."""

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
    words = "folder for the store, which an interrupted run goes on with, and a table (none)"
    parser.add_argument("--out", type=Path, metavar="FOLDER", help=words)
    shared.add(parser, "--json")


def run_sequences(options: argparse.Namespace) -> int:
    """Run solvers; print a line for each solver and mode. InputError if that is not possible."""
    from quasistatic_ref.formats.files import text_written
    from quasistatic_ref.lab.folders import problem_set_folder
    from quasistatic_ref.lab.study.calling.solvers import Setting
    from quasistatic_ref.lab.study.file.study_file import Part, Study
    from quasistatic_ref.lab.study.measuring.run import run_study
    from quasistatic_ref.lab.study.problems.folder import set_read
    from quasistatic_ref.lab.study.problems.for_study import TestSet, fact_of
    from quasistatic_ref.lab.study.report.rows import rows_of
    from quasistatic_ref.lab.study.report.tables import sequence_tables

    shared.check_at_least_one(options, "repetitions")
    if not 0 < options.accuracy < 1:
        raise InputError("must be between 0 and 1", field="--accuracy", value=options.accuracy)
    for name in ("time_limit", "memory", "budget"):
        if not 0 < (value := getattr(options, name)) < LONGEST:
            words = f"must be above 0 and below {LONGEST:g}"
            raise InputError(words, field=f"--{name.replace('_', '-')}", value=value)
    setting = Setting("sequences", options.accuracy, 0.0)
    solvers = tuple(_solver(name, setting) for name in options.solvers)
    modes = _modes(solvers, options.modes.split(",") if options.modes else None)
    problems = [
        one
        for one in set_read(problem_set_folder(), ["sequences"])
        if options.scenario in (None, one.facts["sequence"]["name"].partition("/")[0])
        and one.facts["dial"] == options.stride
    ]
    if not problems:
        raise InputError("have no such sequence", field="--scenario and --stride",
                         value=[options.scenario, options.stride])  # fmt: skip
    part = Part(solvers, (setting,), ("natural",), (False,), every=1, again=0, modes=modes)
    study = Study(
        Path("sequences.toml"), TestSet(1, {"sequences": len(problems)}, ()),
        options.time_limit, options.budget, max(WARM_UP, options.time_limit),
        1e9 * options.memory, options.repetitions, (part,),
    )  # fmt: skip
    with _folder(options.out) as folder:
        rows = run_study(study, folder, problems=problems, progress=not options.quiet)
    facts = {one.id: fact_of(one) for one in problems}
    if options.out is not None:
        path = text_written(options.out / "sequences.csv", _table(rows, facts))
        print(f"wrote {path}", file=sys.stderr if options.json else sys.stdout)
    if options.json:
        shared.print_json(rows)
        return 0
    every = rows_of(rows, options.time_limit)
    for table in sequence_tables(every, list(facts.values())):
        shared.print_rows([table.columns, *table.rows])
    ends = Counter((label_of(r), r["mode"], r["outcome"]) for r in rows)
    for (solver, mode, outcome), count in ends.items():
        if outcome not in ORDINARY:
            print(f"{solver}, {mode}: {count} {outcome.replace('_', ' ')}")
    return 0


def _solver(name: str, setting: Any) -> Any:
    """A solver; a name alone is that of a backend, in its own interface.

    One that has nothing to set is called without options.
    """
    from quasistatic_ref.lab.study.measuring.ask import solver_named

    found = solver_named(name if ":" in name else f"native:{name}")
    return found if found.takes(setting) else replace(found, options={setting.name: {}})


def _modes(solvers: Sequence[Any], named: Sequence[str] | None) -> tuple[str, ...]:
    """The modes that are named, if all solvers can do them; else every mode that there is."""
    from quasistatic_ref.lab.study.measuring.run import modes_of_solver

    for mode in named or ():
        if mode not in MODES:
            raise InputError(f"is none of {', '.join(MODES)}", field="--modes", value=mode)
    for solver in solvers:
        own = modes_of_solver(solver)
        for mode in named or ():
            if mode not in own:
                words = f"is no mode of {solver.label}, which has {', '.join(own)}"
                raise InputError(words, field="--modes", value=mode)
    return tuple(named or MODES)


def _folder(out: Path | None) -> AbstractContextManager[str | Path]:
    """The folder of the store: that which is given, or one for the time being."""
    return TemporaryDirectory() if out is None else nullcontext(out)


def _table(rows: Sequence[Row], facts: Mapping[str, Mapping[str, Any]]) -> str:
    """One line a problem and mode."""
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow(["sequence", "place", "solver", "mode", "outcome", "said", "digits",
                    "iterations", "seconds"])  # fmt: skip
    for row in rows:
        fact = facts[row["problem"]]
        lines.writerow([fact["sequence"], fact["place"], label_of(row), row["mode"],
                        row["outcome"], row["claimed"], row["digits"]["delta_q"],
                        row["iterations"], row["seconds"]["call"]])  # fmt: skip
    return text.getvalue()
