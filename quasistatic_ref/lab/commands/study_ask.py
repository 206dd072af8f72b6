"""``study ask``: one problem, one solver, one setting; how right, how fast, and what it claims."""

import argparse
from pathlib import Path
from typing import Any

from quasistatic_ref.cli import options as shared
from quasistatic_ref.lab.study.problems.names import NATURAL, UNITS


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare problem, solver and setting."""
    parser.add_argument("problem", metavar="PROBLEM", help="id, such as capped_wedge/0.1/0")
    words = "interface:name, such as qpsolvers:daqp, or module:function"
    parser.add_argument("solver", metavar="SOLVER", help=words)
    words = "default (if not given), low, mid, high, tuned, or one of the study's own"
    parser.add_argument("setting", nargs="?", default="default", metavar="SETTING", help=words)
    parser.add_argument("--units", default=NATURAL, choices=UNITS, help="natural (default), raw")
    parser.add_argument("--warm", action="store_true", help="from the answer to a neighbour")
    words = "of a study: its problems, solvers, options and limits"
    parser.add_argument("--store", type=Path, metavar="FOLDER", help=words)
    shared.add(parser, "--json")


def run_ask(options: argparse.Namespace) -> int:
    """Run the solver, and print what came of it; 1 if the solver's claim is false."""
    from quasistatic_ref.lab.study.measuring.ask import measured_again, question

    one = question(options.problem, options.solver, options.setting, options.units, options.warm,
                   options.store)  # fmt: skip
    row = measured_again(one)
    if options.json:
        shared.print_json({"problem": options.problem, "solver": one.solver.label,
                           "setting": one.setting.name, **row})  # fmt: skip
    else:
        for name, words in _lines(one, row):
            print(f"{name:<13}{words}")
    return int(row["wrong"] or row["wrong_multipliers"])


def _lines(one: Any, row: dict[str, Any]) -> list[tuple[str, str]]:
    from quasistatic_ref.lab.study.calling.promises import promise_words
    from quasistatic_ref.lab.study.report.words import milliseconds, options_words

    form = one.problem.form
    facts = one.problem.facts
    seconds = row["seconds"]
    options = options_words(one.solver.settings_of(one.setting, one.limits.time_limit))
    false = [
        words
        for words, holds in (
            ("said optimal, was wrong", row["wrong"] and row["said_optimal"]),
            ("said infeasible, was wrong", row["wrong"] and row["said_infeasible"]),
            ("wrong multipliers", row["wrong_multipliers"]),
        )
        if holds
    ]
    time = "-" if seconds["call"] is None else f"{milliseconds(seconds['call'])} ms"
    if seconds["low"] is not None:
        span = " to ".join(milliseconds(seconds[name]) for name in ("low", "high"))
        time += f", quartiles {span} ms, {row['calls']} calls"
    return [
        ("problem", f"{one.problem.id}: {len(form.g)} coordinates, {len(form.b)} rows, "
         f"{facts['contacts']} contacts" + ("" if row["feasible"] else ", no solution")),
        ("call", f"{one.solver.label} at {one.setting.name} ({options}), {one.units} units, "
         f"{'warm' if one.warm else 'cold'}"),
        ("outcome", f"{row['outcome']}; its own status: {row['claimed']}"),
        ("digits", _values_in_words(row["digits"], ".1f")),
        ("residuals", _values_in_words(row["residuals"], ".1e")),
        ("promised", promise_words(one.solver.promises(one.setting))),
        ("limits", _values_in_words(row["allowed"], ".1e")),
        ("time", time),
        ("false claims", ", ".join(false) or "none"),
    ]  # fmt: skip


def _values_in_words(values: dict[str, float | None], form: str) -> str:
    return ", ".join(f"{name} {'-' if v is None else format(v, form)}" for name, v in
                     values.items())  # fmt: skip
