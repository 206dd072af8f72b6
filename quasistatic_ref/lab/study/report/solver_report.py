"""The report on solvers: which one, at which setting, how right, how fast, where it fails."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section
from quasistatic_ref.lab.study.report.columns import (
    chosen,
    columns_of,
    common,
    groups,
    matrix,
    size,
)
from quasistatic_ref.lab.study.report.comparison import Comparison, comparison_of
from quasistatic_ref.lab.study.report.headline import WANTED, soonest_table
from quasistatic_ref.lab.study.report.judged_tables import (
    claims_sentence,
    detection,
    failing_clocks,
    parts_of_calls,
)
from quasistatic_ref.lab.study.report.noise import noise_words
from quasistatic_ref.lab.study.report.numbers import filter_words
from quasistatic_ref.lab.study.report.report_words import (
    limitations,
    method,
    options_table,
    place_tables,
    settings_table,
)
from quasistatic_ref.lab.study.report.sequences import sequence_tables
from quasistatic_ref.lab.study.report.solver_tables import (
    LEVELS,
    contrast,
    false_claims,
    family_digits,
    family_table,
    outcome_table,
    problem_table,
    same_problems,
    solver_table,
    worst_claims,
)
from quasistatic_ref.lab.study.report.statistics import performance_ratios, success
from quasistatic_ref.lab.study.report.worst import worst_problems
from quasistatic_ref.lab.study.store.store import Contents

PROFILED = (6.0, 9.0)
"""Digits that count as right in a profile."""


def solver_report(found: Contents) -> Report:
    """The report on a store of solvers.

    Parameters
    ----------
    found : Contents
    """
    study, facts = found.study, found.problems
    every = columns_of(found.rows, study["time_limit"])
    first = chosen(every, {"repetition": 0})
    alone = chosen(every, {"mode": ""})
    head = (
        f"{len(facts):,} problems, {len(set(every['way'])):,} pairs of solver and interface, "
        f"{len(found.rows):,} measurements."
    )
    sections: dict[str, Sequence[Block]] = {}
    if size(alone):
        sections |= _of_problems(comparison_of(study, alone), found, head)
    sections |= {
        "Steps in order": sequence_tables(found.rows, facts),
        "How calls ended": [outcome_table(first), *failing_clocks(first)],
        "Method": [*method(study["time_limit"]), settings_table(study["settings"])],
        "Limitations": limitations(),
        "Problems": [problem_table(facts)],
        "Machine, versions, options": [*place_tables(study), options_table(study["solvers"])],
    }
    title = "Solvers on contact problems with exact answers"
    parts = (Section(name, tuple(part)) for name, part in sections.items() if part)
    return Report(title, tuple(parts))


def _of_problems(comparison: Comparison, found: Contents, head: str) -> dict[str, Sequence[Block]]:
    """The sections on problems that were solved one at a time."""
    columns, facts = comparison.columns, found.problems
    if machines := found.study.get("machines"):
        head += f" Made on {len(machines)} machines: {', '.join(machines)}; "
        head += f"the figures are of {comparison.drawn}."
    heads = [head, noise_words(comparison.noise)]
    fastest = [(one.label, one.setting) for one in comparison.fastest()]
    families = list(dict.fromkeys(fact["family"] for fact in facts))
    calls = [(one.rows, one.setting) for one in comparison.soonest(WANTED[0])]
    return {
        "Time to so many digits": [*heads, *_headline(comparison, found.unreached)],
        "Accuracy and time": _compared(comparison),
        "False claims": [*_claims(comparison), *detection(comparison.first)],
        "Worst problems": worst_problems(columns, comparison.base, fastest, facts),
        "By problem family": _by_family(comparison, families),
        "Units, warm starts, interfaces": _contrasts(comparison),
        "Set-up, solving, conversion": parts_of_calls(calls, comparison.base),
    }


def _headline(comparison: Comparison, unreached: Mapping[str, str]) -> list[Block]:
    options = {f"{s['interface']}:{s['name']}": s["options"] for s in comparison.study["solvers"]}
    tables = []
    for least in WANTED:
        shown = options if least == WANTED[0] else None
        tables.append(
            soonest_table(comparison.soonest(least), comparison.base, comparison.noise, shown)
        )
    there = set(chosen(comparison.columns, comparison.base)["label"])
    words = [f"{label} was left out: it {reason}." for label, reason in unreached.items()]
    if missing := sorted(set(comparison.columns["label"]) - there):
        names = f"{', '.join(missing)} {'was' if len(missing) == 1 else 'were'}"
        words.append(
            f"{names} never run with {filter_words(comparison.base)}, and cannot be compared."
        )
    return [*words, *tables]


def _compared(comparison: Comparison) -> list[Block]:
    panels, shares, said, best = [], [], [], comparison.best()
    for least in PROFILED:
        found = {one.label: one for one in comparison.soonest(least)}
        lines = [found[label] for label in best if label in found]
        if not lines:
            continue
        order = [np.argsort(one.rows["unit"]) for one in lines]
        times = np.array([one.rows["seconds"][at] for one, at in zip(lines, order, strict=True)])
        good = np.array([one.rows["digits"][at] for one, at in zip(lines, order, strict=True)])
        ratios = performance_ratios(times, good >= least)
        title = f"right to {least:g} digits"
        panels.append({"title": title, "labels": [one.label for one in lines], "ratios": ratios})
        said.append(f"{title}{same_problems(lines[0].rows)}")
    settings = "; ".join(said) + "; each at the setting of the table of that time"
    profiles = f"{filter_words(comparison.base)}; {settings}"
    said = []
    for setting in comparison.main:
        own = common(chosen(comparison.columns, comparison.at(setting)))
        labels = [label for (label,), _ in groups(own, ["label"]) if label in best]
        if labels:
            right = matrix(own, "digits", labels)
            of = np.array([[success(d, level) for level in LEVELS] for d in right])
            shares.append({"title": setting, "labels": labels, "shares": of})
            said.append(f"setting = {setting}{same_problems(own)}")
    rows = f"{filter_words(comparison.base)}; {'; '.join(said)}"
    words, levels = "Problems solved to 3, 6 and 9 correct digits.", {"levels": LEVELS}
    caption = (
        "Performance profiles, of each solver through the interface with the fastest 6 digits."
    )
    return [
        _picture("profiles", panels, caption, profiles),
        _picture("success", shares, words, rows, **levels),
        _against_time(comparison, best),
        *(
            solver_table(comparison.columns, comparison.at(setting))
            for setting in comparison.settings
        ),
    ]


def _picture(name: str, panels: list[Any], caption: str, where: str, **more: Any) -> Block:
    """A picture, or a sentence in place of one that would be empty."""
    if not panels:
        return (
            f"There is no problem that all solvers were run on: the figure `{name}` is not drawn."
        )
    return Picture(name, name, {"panels": panels, **more}, caption, where)


def _against_time(comparison: Comparison, best: Sequence[str]) -> Block:
    """Digits against time: a line a solver, a mark a setting, all on the same problems."""
    own_ = {s["name"]: s["accuracy"] is None for s in comparison.study["settings"]}
    panels, said = [], []
    for units in sorted(set(comparison.columns["units"])):
        own = common(
            chosen(comparison.columns, {**comparison.base, "units": units}), ["label", "setting"]
        )
        lines = {
            label: [
                (own_[s], float(np.median(at["seconds"])), float(np.median(at["digits"])))
                for s in comparison.settings
                if size(at := chosen(part, {"setting": s}))
            ]
            for (label,), part in groups(own, ["label"])
            if label in best
        }
        if lines:
            panels.append({"title": f"{units} units", "lines": lines})
            said.append(f"units = {units}{same_problems(own)}")
    where = {name: value for name, value in comparison.base.items() if name != "units"}
    caption = (
        "Median digits against median time of a call. Each mark is a setting: half "
        "filled the solver's own, filled the tightest. A line joins the solver's other settings, "
        "from loose to tight."
    )
    return _picture("digits_time", panels, caption, f"{filter_words(where)}; {'; '.join(said)}")


def _claims(comparison: Comparison) -> list[Block]:
    columns = comparison.columns
    promised = {s["name"]: s["promised"] for s in comparison.study["settings"]}
    tables = [
        false_claims(columns, comparison.settings, {"units": units, "warm": warm == "True"})
        for (units, warm), _ in sorted(groups(columns, ["units", "warm"]), key=lambda one: one[0])
    ]
    return [*claims_sentence(columns), *tables, worst_claims(columns, promised)]


def _by_family(comparison: Comparison, families: Sequence[str]) -> list[Block]:
    panels, tables, said = [], [], []
    for setting in comparison.main:
        where = comparison.at(setting)
        labels, found = family_digits(comparison.columns, where, families)
        more = same_problems(common(chosen(comparison.columns, where)))
        if not labels:
            continue
        panel = {"labels": labels, "families": families, "digits": found}
        panels.append({"title": f"setting {setting}", **panel})
        tables.append(family_table(labels, found, where, families, more))
        said.append(f"setting = {setting}{more}")
    caption = "Median digits delivered, by problem family and solver."
    rows = f"{filter_words(comparison.base)}; {'; '.join(said)}"
    return [_picture("families", panels, caption, rows), *tables]


def _contrasts(comparison: Comparison) -> list[Block]:
    units, cold = {"units": comparison.base["units"]}, {"warm": False}
    columns, ways = (comparison.columns, comparison.settings), ["label", "setting"]
    raw = ("raw", "natural")
    tables = [
        contrast(*columns, "Raw units and natural units.", "units", raw, cold, ways),
        contrast(*columns, "Cold and warm starts.", "warm", (False, True), units, ways, True),
    ]
    if len(machines := comparison.study.get("machines", [])) > 1:
        way, where = ["way", "setting"], units | cold
        tables.append(contrast(*columns, "Machines.", "machine", machines, where, way))
    for one, other in (("qpsolvers", "cvxpy"), ("native", "qpsolvers")):
        title = f"{one} and {other}."
        tables.append(contrast(*columns, title, "interface", (one, other), units | cold))
    return [table for table in tables if table.rows]
