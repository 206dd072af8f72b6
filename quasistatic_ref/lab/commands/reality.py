"""``validate reality``: measured pushes, predicted with friction identified from measured loads."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.step.cones import ELLIPSOID, cone
from quasistatic_ref.text.content import text_written, writable_folder
from quasistatic_ref.text.json_text import json_text

NAME = "reality"
"""What the command ``validate`` is given."""

OPTIONS = ("sets", "cone", "fraction", "jobs")
"""Of ``validate`` that are for this only."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options that are for measured pushes only."""
    group = parser.add_argument_group("for 'reality' only")
    words = "predict pushes of these pairs of surface and shape only: abs/rect1,..."
    group.add_argument("--sets", metavar="A/B,...", help=words)
    group.add_argument("--cone", metavar="NAME", help=f"friction cone (default: {ELLIPSOID})")
    words = "predict this share of each pair's pushes, e.g. 0.1"
    group.add_argument("--fraction", type=float, metavar="X", help=words)
    group.add_argument(
        "--jobs", type=int, metavar="N", help="number of processes (default: all cores)"
    )


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
        If an option is not usable.
    """
    name = options.cone or ELLIPSOID
    cone(name)  # refuses a name that it does not know
    fraction = 1.0 if options.fraction is None else options.fraction
    if not 0 < fraction <= 1:
        raise InputError("must be greater than 0, at most 1", field="--fraction", value=fraction)
    shared.check_at_least_one(options, "jobs")
    return _exit_status(options, Settings(cone=name), round(1 / fraction))


def _exit_status(options: argparse.Namespace, settings: Settings, every: int) -> int:
    from quasistatic_ref.lab.parallel import workers
    from quasistatic_ref.lab.reality.measurements import pairs_read, pushes_read
    from quasistatic_ref.lab.reality.report import certified_words, error_rows, predictions_text
    from quasistatic_ref.lab.reality.run import PROOFS, predicted_pushes

    pairs = pairs_read(options.sets.split(",") if options.sets else ())
    if min(len(some.every(every).before) for some in pushes_read(pairs).values()) < 2:
        problem = "leaves a pair fewer than two pushes; raise it"
        raise InputError(problem, field="--fraction", value=options.fraction)
    folder = writable_folder(options.out)
    with workers(options.jobs) as executor:
        record, ends = predicted_pushes(
            settings, pairs, every, executor, progress=not options.quiet
        )
    summary = text_written(folder / "reality.json", json_text(record) + "\n")
    text_written(folder / "reality.csv", predictions_text(ends, every))
    good = set(record["steps"]) <= {*PROOFS}
    if options.json:
        shared.print_json(record)
        return 0 if good else 1
    shared.print_rows(error_rows(record))
    print(certified_words(record))
    print(f"wrote {summary} and reality.csv next to it")
    return 0 if good else 1
