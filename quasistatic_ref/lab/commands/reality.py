"""``validate reality``: measured pushes, predicted with friction identified from measured loads."""

import argparse
import sys
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text, text_written, writable_folder
from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.step.cones import ELLIPSOID, cone

NAME = "reality"
"""What the command ``validate`` is given."""

OPTIONS = ("data", "sets", "cone", "fraction", "jobs")
"""Of ``validate`` that are for this only."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options that are for measured pushes only."""
    group = parser.add_argument_group("for 'reality', measured pushes, only")
    group.add_argument(
        "--data", type=Path, metavar="FOLDER", help="pushes of your own (default: those of MIT)"
    )
    group.add_argument(
        "--sets", metavar="A/B,...", help="some pairs only, by surface and shape: abs/rect1,..."
    )
    group.add_argument("--cone", metavar="NAME", help=f"friction cone, {ELLIPSOID} if none")
    group.add_argument(
        "--fraction", type=float, metavar="X", help="0.1: every tenth push of each pair"
    )
    group.add_argument("--jobs", type=int, metavar="N", help="processes (default: all cores)")


def refuse(options: argparse.Namespace) -> None:
    """Refuse the options of this command where claims are measured.

    Raises
    ------
    InputError
        Naming the first of them.
    """
    for name in OPTIONS:
        if (value := getattr(options, name)) is not None:
            raise InputError(f"is for 'validate {NAME}' only", field=f"--{name}", value=value)


def run(options: argparse.Namespace) -> int:
    """Identify, predict, print tables; exit status 1 if a step was not certified.

    Raises
    ------
    InputError
        If an option or a file is not usable.
    """
    name = options.cone or ELLIPSOID
    cone(name)  # refuses a name that it does not know
    if name == "frictionless":
        raise InputError("has no friction to identify", field="--cone", value=name)
    fraction = 1.0 if options.fraction is None else options.fraction
    if not 0 < fraction <= 1:
        raise InputError("must be greater than 0, at most 1", field="--fraction", value=fraction)
    shared.check_at_least_one(options, "jobs")
    try:
        return _exit_status(options, name, round(1 / fraction))
    except KeyboardInterrupt:
        kept = f"what was predicted is in {options.out}; the same command goes on from there"
        print(f"quasistatic-ref: interrupted; {kept}", file=sys.stderr)
        return 130


def _exit_status(options: argparse.Namespace, name: str, step: int) -> int:
    from quasistatic_ref.lab.reality.identify import identified_ratio
    from quasistatic_ref.lab.reality.loads import loads_read
    from quasistatic_ref.lab.reality.pairs import pairs_read
    from quasistatic_ref.lab.reality.predictions import predicted_pushes
    from quasistatic_ref.lab.reality.pushes import pushes_read
    from quasistatic_ref.lab.reality.report import (
        certified_words,
        error_rows,
        identified_record,
        identified_rows,
        predictions_text,
        reality_record,
    )
    from quasistatic_ref.lab.reality.settings import Settings

    data = options.data or reality_folder()
    pairs = pairs_read(data, options.sets.split(",") if options.sets else ())
    loads = loads_read(data, pairs)
    by_pair = {p.name: identified_ratio(loads[p.name], p.outline.gyration, name) for p in pairs}
    known = [p for p in pairs if by_pair[p.name] is not None]
    ratios = {key: value.ratio for key, value in by_pair.items() if value is not None}
    if not known:
        raise InputError("has no loads of these pairs", file=data / "loads.csv")
    pushes = {key: value.every(step) for key, value in pushes_read(data, known).items()}
    folder = writable_folder(options.out)
    settings = Settings(cone=name)
    file = folder / f"reality_{name}{'' if step == 1 else f'_every_{step}'}.jsonl"
    rows = predicted_pushes(known, pushes, ratios, settings, file, jobs=options.jobs,
                            progress=not options.quiet)  # fmt: skip
    record = reality_record(settings, ratios, pushes, rows)
    record["every"] = step
    record["identified"] = {key: identified_record(value) for key, value in by_pair.items()}
    summary = text_written(folder / "reality.json", json_text(record) + "\n")
    text_written(folder / "reality.csv", predictions_text(rows))
    good = set(record["steps"]) <= {"exact", "enclosure"}
    if options.json:
        shared.print_json(record)
        return 0 if good else 1
    print("Identified from measured loads:")
    shared.print_rows(identified_rows(pairs, by_pair))
    print("\nMeasured pushes, predicted:")
    shared.print_rows(error_rows(record))
    print(certified_words(record))
    print(f"wrote {file}, {summary} and reality.csv next to them")
    return 0 if good else 1
