"""``run SCENARIO --sweep``: a grid of runs, one table and one trajectory a run."""

import argparse

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.files.scenario.scenario import load_scenario
from quasistatic_ref.lab.sweep import DONE, TABLE, simulate_many, swept_values
from quasistatic_ref.quoting import counted
from quasistatic_ref.text.json_text import json_text

SHOWN = 4
"""Measures of each run that are printed; the rest is in the table."""

OF_ONE_RUN = ("view", "strict", "table")
"""Options of ``run`` that a sweep does not take."""


def run(options: argparse.Namespace) -> int:
    """Run the scenario with each combination of swept values; exit status 1 if a run failed.

    Raises
    ------
    InputError
        If an option is of one run alone, or a sweep cannot be read.
    """
    for name in OF_ONE_RUN:
        if getattr(options, name):
            raise InputError("is of one run; leave out --sweep", field=f"--{name}")
    variations: dict[str, list[float | str]] = {}
    for text in options.sweeps:
        field, values = swept_values(text)
        if field in variations:
            raise InputError("is swept twice; give all of its values at once", field=field)
        variations[field] = values
    settings = shared.scenario_settings(options)
    rows = simulate_many(
        options.scenario,
        variations,
        options.out,
        settings=settings,
        workers=options.jobs,
        progress=not options.quiet,
    )
    failed = sum(row["outcome"] != DONE for row in rows)
    # Of a field that is swept, the scene may need a value of the sweep.
    first = [
        f"{field}={json_text(values[0])}"
        for name, values in variations.items()
        for field in name.split(",")
    ]
    fast = load_scenario(options.scenario, [*settings, *first]).fast
    if options.json:
        summary = {"runs": len(rows), "fast": fast, "failed": failed, "store": str(options.out)}
        shared.print_json(summary)
        return int(failed > 0)
    swept = [name for name, values in variations.items() if len(values) > 1]
    names = list(rows[0]["measures"])[:SHOWN]
    table: list[tuple[str, ...]] = [(*swept, "outcome", *names, "findings")]
    for row in rows:
        numbers = (row["measures"].get(name) for name in names)
        cells = ("-" if v is None else f"{v:.4g}" for v in numbers)
        at = (f"{row['values'][name]}" for name in swept)
        findings = "; ".join(row["findings"]) or "-"
        table.append((*at, row["outcome"], *cells, findings))
    shared.print_rows(table)
    speed = "fast" if fast else "plain"
    print(
        f"{counted(len(rows), 'run')} ({speed} path), {failed} failed; wrote {options.out / TABLE}"
    )
    return int(failed > 0)
