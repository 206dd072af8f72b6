"""The report on solvers: who solves what share to how many digits in what time, on one screen.

All else stands behind that, section by section. The paragraphs are in ``words.md``.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Code, Picture, Report, Section
from quasistatic_ref.lab.study.measuring.false_claims import FACTOR, SPREAD
from quasistatic_ref.lab.study.report import studied, tables
from quasistatic_ref.lab.study.report.cheats import cheat_alone
from quasistatic_ref.lab.study.report.comparison import WANTED, Comparison, comparison_of
from quasistatic_ref.lab.study.report.rows import Where, rows_of
from quasistatic_ref.lab.study.report.statistics import SHIFT, performance_ratios
from quasistatic_ref.lab.study.report.words import filter_words, sentences
from quasistatic_ref.lab.study.store.store import Contents


def solver_report(found: Contents, store: str = ".") -> Report:
    """The report on a store of solvers.

    Parameters
    ----------
    found : Contents
    store : str
        Its folder, as seen from that of the report.

    Returns
    -------
    Report
    """
    study = found.study
    facts = found.problems
    every = rows_of(found.rows, study["time_limit"])
    first = every.at(repetition=0)
    alone = every.at(mode="")
    sections: dict[str, Sequence[Block]] = {}
    if alone:
        comparison = comparison_of(study, alone)
        head = (
            f"{len(facts):,} problems, {len(set(every['way'])):,} pairs of solver and interface, "
            f"{len(found.rows):,} measurements."
        )
        sections |= {"Who solves what": _one_screen(comparison, found.unreached, head, store),
                     **_of_problems(comparison, facts, store)}  # fmt: skip
    method = sentences(
        "method", limit=study["time_limit"], shift=1e3 * SHIFT, factor=FACTOR, spread=SPREAD
    )
    places = [*studied.place_tables(study), studied.options_table(study["solvers"])]
    sections |= {
        "Steps in order": tables.sequence_tables(every, facts),
        "How calls ended": [tables.outcome_table(first)],
        "Method": method,
        "Limitations": sentences("limitations"),
        "Problems": [studied.problem_table(facts)],
        "Machine, versions, options": places,
    }
    title = "Solvers on contact problems with exact answers"
    return Report(title, tuple(Section(n, tuple(part)) for n, part in sections.items() if part))


def _one_screen(
    comparison: Comparison, unreached: Mapping[str, str], head: str, store: str
) -> Sequence[Block]:
    """The table that says most, and the lines that make its numbers again."""
    words = [f"{label} was left out: it {reason}." for label, reason in unreached.items()]
    there = set(comparison.rows.at(comparison.base)["label"])
    for label in sorted(set(comparison.rows["label"]) - there):
        words.append(f"{label} was never run with {filter_words(comparison.base)}.")
    if machines := comparison.study.get("machines"):
        words.append(f"Made on {len(machines)} machines: {', '.join(machines)}; this table and "
                     f"the figures are of {comparison.figure_machine}.")  # fmt: skip
    for one in comparison.soonest:
        if cheat := cheat_alone(comparison.every_call(one).at(feasible=True)):
            words.append(f"{one.label} looks as if it {cheat}.")
    times = comparison.busy or comparison.noise.words
    again = (
        "These lines make the numbers again, but for the bootstraps, for every interface to a "
        "solver, as the next table has them: `table` and `claims`. They read the store that "
        f"`quasistatic-ref study pack {store} --out .` writes."
    )
    table = tables.headline(comparison.fastest(), comparison)
    every = tables.claims_sentences(comparison.every)
    return [head, *every, *words, times, *sentences("times"), table, again,
            Code(lines_of_pandas(comparison))]  # fmt: skip


def lines_of_pandas(comparison: Comparison) -> str:
    """The lines that make the first table again: units, starts and time limit are put in."""
    text = (Path(__file__).parent / "pandas_lines.txt").read_text("utf-8")
    return text.format(
        warm=comparison.base["warm"],
        units=comparison.base["units"],
        least=WANTED,
        limit=comparison.limit,
        shift=SHIFT,
    )


def _of_problems(
    comparison: Comparison, facts: Sequence[Mapping[str, Any]], store: str
) -> dict[str, Sequence[Block]]:
    """The sections on problems that were solved one at a time."""
    best = [one.label for one in comparison.fastest()]
    each: list[Block] = []
    for setting in comparison.settings:
        each += [tables.solver_table(comparison, setting), *_left_out(comparison, setting)]
    profiles = [] if comparison.busy else [_profiles(comparison, best)]
    rows = comparison.rows
    false = [
        tables.false_claims(comparison.first, comparison.settings, {"units": units, "warm": warm})
        for units, warm in sorted(rows.groups("units", "warm"))
    ]
    asked = [one["name"] for one in comparison.study["settings"] if one["accuracy"]]
    asked = [name for name in comparison.settings if name in asked]
    return {
        "Every interface": [tables.interface_table(comparison)],
        "Accuracy and time": [*profiles, _against_time(comparison, best), *each],
        "Claims": [*false, tables.detection(comparison.first)],
        "Tolerances and digits": _kept_digits(comparison, asked),
        "Worst problems": tables.worst_problems(comparison, facts, comparison.fastest(), store),
        "By problem family": [tables.family_table(comparison, name) for name in comparison.main],
        "Units, warm starts, interfaces": _contrasts(comparison),
    }


def _left_out(comparison: Comparison, setting: str) -> list[str]:
    """The solvers that a setting means nothing to."""
    absent = [name for name, options in comparison.options.items() if setting not in options]
    if not absent:
        return []
    return [f"Not called at {setting}, which means nothing to them: {', '.join(absent)}."]


def _kept_digits(comparison: Comparison, settings: Sequence[str]) -> list[Block]:
    """Accuracy against digits, of answers that kept their tolerances."""
    if not settings:
        return []
    rows = comparison.calls
    table = tables.kept_digits(rows, settings)
    lines = {line[0]: line[1:] for line in table.rows}
    data = {"settings": settings, "lines": lines} if lines else {}
    caption = (
        "Digits of the answers that kept their tolerances, family by family: from the 5th "
        "percentile to the median (the mark), one line for each accuracy."
    )
    kept = {**comparison.base, **tables.KEPT}
    return [*sentences("digits"), _picture("kept_digits", data, caption, kept, ""), table]


def _profiles(comparison: Comparison, best: Sequence[str]) -> Block:
    found = {one.label: one.setting for one in comparison.soonest if one.label in best}
    own = comparison.calls.kept(lambda row: found.get(row["label"]) == row["setting"]).common()
    parts = {label: part for (label,), part in own.groups("label").items()}
    data = {}
    if parts:
        times = np.array([part.sorted_by_unit("seconds") for part in parts.values()])
        good = np.array([part.sorted_by_unit("digits") for part in parts.values()])
        ratios = performance_ratios(times, good >= WANTED)
        title = f"right to {WANTED:g} digits"
        data = {"title": title, "labels": list(parts), "ratios": ratios}
    words = "Performance profiles, each solver at its setting and interface of the first table."
    return _picture("profiles", data, words, comparison.base, tables.same_problems(own))


def _picture(name: str, data: Mapping[str, Any], caption: str, where: Where, said: str) -> Block:
    """A picture, or a sentence in place of one that would be empty."""
    if not data:
        return (
            f"There is no problem that all solvers were run on: the figure `{name}` is not drawn."
        )
    return Picture(name, name, data, caption, f"{filter_words(where)}{said}")


def _against_time(comparison: Comparison, best: Sequence[str]) -> Block:
    """Digits against time: a line a solver, a mark a setting, all on the same problems."""
    own_ = {s["name"]: s["accuracy"] is None for s in comparison.study["settings"]}
    own = comparison.calls.common("label", "setting")
    lines = {
        label: [
            (own_[s], float(np.median(at["seconds"])), float(np.median(at["digits"])))
            for s in comparison.settings
            if (at := part.at(setting=s))
        ]
        for (label,), part in own.groups("label").items()
        if label in best
    }
    data = {"title": f"{comparison.base['units']} units", "lines": lines} if lines else {}
    caption = (
        "Median digits against median time of a call. Each mark is a setting: half "
        "filled the solver's own, filled the tightest. A line joins the solver's other settings, "
        "from loose to tight."
    )
    more = tables.same_problems(own)
    return _picture("digits_time", data, caption, comparison.base, more)


def _contrasts(comparison: Comparison) -> list[Block]:
    units = {"units": comparison.base["units"]}
    cold = {"warm": False}
    ways = ("label", "setting")
    raw = ("raw", "natural")
    found = [
        tables.contrast(comparison, "Raw units and natural units.", "units", raw, cold, ways),
        tables.contrast(comparison, "Cold and warm starts.", "warm", (False, True), units, ways,
                        iterations=True),
    ]  # fmt: skip
    where = units | cold
    if len(machines := comparison.study.get("machines", [])) > 1:
        way = ("way", "setting")
        found.append(tables.contrast(comparison, "Machines.", "machine", machines, where, way))
    for one, other in (("qpsolvers", "cvxpy"), ("native", "qpsolvers")):
        title = f"{one} and {other}."
        found.append(tables.contrast(comparison, title, "interface", (one, other), where))
    return [table for table in found if table.rows]
