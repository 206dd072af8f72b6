"""``study``: compare solvers, write the page of what was found."""

import argparse
import sys
from collections import Counter
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.main import parsers_of
from quasistatic_ref.lab.commands import study_problems
from quasistatic_ref.lab.study.row import Row
from quasistatic_ref.lab.study.saying import SAYINGS
from quasistatic_ref.text.content import writable_folder

ACTIONS = {
    "run": "run the default study, or go on with one that was stopped",
    "report": "write tables and figures of the rows of studies",
    "problems": "sets of problems with exact answers: list, export, check",
}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the commands below this one, and their options."""
    parsers = parsers_of(parser, "action", ACTIONS)
    study_problems.add_options(parsers["problems"])
    run_ = parsers["run"]
    shared.add(run_, "--out", default="study")
    run_.add_argument("--quick", action="store_true", help="put only a twentieth of the problems")
    shared.add(run_, "--json")
    report = parsers["report"]
    words = "folder of a study that was run; rows of several are put together"
    report.add_argument("studies", nargs="+", type=Path, metavar="FOLDER", help=words)
    shared.add(report, "--out", default=Path("report"))


def run(options: argparse.Namespace) -> int:
    """Run the action that was named."""
    actions = {"run": _run, "report": _report, "problems": study_problems.run_problems}
    return actions[options.action](options)


def _report(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.page import page_written
    from quasistatic_ref.lab.study.store import rows_read

    rows = {row: None for folder in options.studies for row in rows_read(folder)}
    for path in page_written(list(rows), writable_folder(options.out)):
        print(f"wrote {path}")
    return 0


def _run(options: argparse.Namespace) -> int:
    shared.progress_line(options, "loads solvers")  # said at once: to import them takes seconds
    from quasistatic_ref.lab.study.default import default_study
    from quasistatic_ref.lab.study.store import ROWS

    try:
        rows = default_study(options.out, quick=options.quick, progress=not options.quiet)
    except KeyboardInterrupt:
        kept = f"what was measured is in {options.out}; the same command goes on from there"
        print(f"quasistatic-ref: interrupted; {kept}", file=sys.stderr)
        return 130
    if options.json:
        counts = Counter(row.says for row in rows)
        shared.print_json({"rows": len(rows), "says": dict(counts), "store": str(options.out)})
        return 0
    shared.print_rows(_summary(rows))
    print(f"wrote {Path(options.out) / ROWS}")
    return 0


def _summary(rows: list[Row]) -> list[tuple[str, ...]]:
    """A line for each solver: its number of calls, and what it said."""
    lines: list[tuple[str, ...]] = [("solver", "calls", *SAYINGS)]
    for label in sorted({f"{row.door}:{row.solver}" for row in rows}):
        said = Counter(row.says for row in rows if f"{row.door}:{row.solver}" == label)
        counts = (said.total(), *(said[says] for says in SAYINGS))
        lines.append((label, *map(str, counts)))
    return lines
