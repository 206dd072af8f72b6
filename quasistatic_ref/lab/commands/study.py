"""``study``: compare solvers, report what was found."""

import argparse
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.main import parsers_of
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.commands import study_ask, study_problems
from quasistatic_ref.lab.commands.study_report import run_merge, run_pack, run_report
from quasistatic_ref.lab.study.store.rows import OUTCOMES, Row, label_of
from quasistatic_ref.lab.study.store.store import STORE, contents

ACTIONS = {
    "run": "run a study; one that was interrupted goes on where it stopped",
    "report": "write what a study says: a self-contained HTML page, Markdown, figures",
    "ask": "run one solver on one problem, in a process of its own, and grade the answer",
    "problems": "sets of problems with exact answers: list, export, check",
    "merge": "join the results of several machines into one store",
    "pack": "write a study's rows compressed, their numbers shortened, to be kept",
}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the commands below this one, and their options."""
    parsers = parsers_of(parser, "action", ACTIONS)
    study_problems.add_options(parsers["problems"])
    study_ask.add_options(parsers["ask"])
    run_ = parsers["run"]
    words = "a TOML file, or a name such as 'default'"
    study = run_.add_argument("study", metavar="STUDY", help=words)
    shared.completed(study, _studies, ".toml")
    shared.add(run_, "--out", default="study")
    run_.add_argument("--quick", action="store_true", help="a twentieth of the problems")
    run_.add_argument(
        "--jobs", type=int, metavar="N", help="solvers called at once (default: all cores)"
    )
    run_.add_argument(
        "--scheduler", metavar="ADDRESS", help="a Dask scheduler, in place of this machine's cores"
    )
    shared.add(run_, "--json")
    words = "results of a machine, and its name; else the folder's"
    merge = parsers["merge"]
    merge.add_argument("parts", nargs="+", metavar="[NAME=]FOLDER", help=words)
    shared.add(merge, "--out", default=Path("merged"))
    for name, folder in (("report", "report"), ("pack", "packed")):
        words = "of a study that was run"
        parsers[name].add_argument("store", type=Path, metavar="FOLDER", help=words)
        words = f"folder for the results (default: {folder}, in that of the study)"
        parsers[name].add_argument("--out", type=Path, metavar="FOLDER", help=words)


def _studies() -> list[str]:
    from quasistatic_ref.lab.study.file.study_file import study_names

    return sorted(study_names())


def run(options: argparse.Namespace) -> int:
    """Run the action that was named."""
    actions: dict[str, Callable[[argparse.Namespace], int]] = {
        "run": _run,
        "ask": study_ask.run_ask,
        "problems": study_problems.run_problems,
        "report": run_report,
        "merge": run_merge,
        "pack": run_pack,
    }
    return actions[options.action](options)


def _run(options: argparse.Namespace) -> int:
    shared.check_at_least_one(options, "jobs")
    shared.progress_line(options, "loads solvers")  # said at once: to import them takes seconds
    from quasistatic_ref.lab.study.file.study_file import study_path

    try:
        return _exit_status(study_path(options.study), options)
    except KeyboardInterrupt:
        kept = f"what was measured is in {options.out}; the same command goes on from there"
        print(f"quasistatic-ref: interrupted; {kept}", file=sys.stderr)
        return 130


def _exit_status(path: Path, options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.file.study_file import solver_study
    from quasistatic_ref.lab.study.measuring.run import run_study

    study = solver_study(path, toml_read(path), options.quick)
    rows = run_study(
        study,
        options.out,
        jobs=options.jobs,
        scheduler=options.scheduler,
        progress=not options.quiet,
    )
    if options.json:
        counts = Counter(row["outcome"] for row in rows)
        shared.print_json({"rows": len(rows), "outcomes": dict(counts), "store": str(options.out)})
        return 0
    shared.print_rows(_summary(rows))
    for label, reason in contents(options.out).unreached.items():
        print(f"{label} was left out: it {reason}")
    print(f"wrote {options.out / STORE}")
    return 0


def _summary(rows: list[Row]) -> list[tuple[str, ...]]:
    """One line a solver: how many calls, how they ended, if any did so, false claims."""
    ends = {row["outcome"] for row in rows}
    columns = [outcome for outcome in OUTCOMES if outcome in ends]
    names = (c.replace("_", " ") for c in columns)
    table: list[tuple[str, ...]] = [
        ("solver", "calls", *names, "said optimal, was wrong", "said infeasible, was wrong")
    ]
    for label in sorted({label_of(row) for row in rows}):
        own = [row for row in rows if label_of(row) == label]
        counts = Counter(row["outcome"] for row in own)
        wrong = [
            sum(row["wrong"] and row[f"said_{claim}"] for row in own)
            for claim in ("optimal", "infeasible")
        ]
        cells = (str(counts[c]) for c in columns)
        table.append((label, str(len(own)), *cells, *map(str, wrong)))
    return table
