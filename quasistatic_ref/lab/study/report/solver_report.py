"""The report on solvers: which one, at which setting, how right, how fast, where it fails."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section
from quasistatic_ref.lab.study.report import tables
from quasistatic_ref.lab.study.report.comparison import WANTED, Comparison, comparison_of
from quasistatic_ref.lab.study.report.rows import Where, rows_of
from quasistatic_ref.lab.study.report.statistics import SHIFT, performance_ratios, success
from quasistatic_ref.lab.study.report.tables import LEVELS, same_problems
from quasistatic_ref.lab.study.report.words import filter_words, sentences
from quasistatic_ref.lab.study.store.store import Contents

PROFILED = (6.0, 9.0)
"""Digits that count as right in a profile."""


def solver_report(found: Contents) -> Report:
    """The report on a store of solvers.

    Parameters
    ----------
    found : Contents

    Returns
    -------
    Report
    """
    study, facts = found.study, found.problems
    every = rows_of(found.rows, study["time_limit"])
    first, alone = every.at(repetition=0), every.at(mode="")
    head = (
        f"{len(facts):,} problems, {len(set(every['way'])):,} pairs of solver and interface, "
        f"{len(found.rows):,} measurements."
    )
    sections: dict[str, Sequence[Block]] = {}
    if alone:
        sections |= _of_problems(comparison_of(study, alone), found, head)
    method = sentences("method", limit=study["time_limit"], shift=1e3 * SHIFT)
    places = [*tables.place_tables(study), tables.options_table(study["solvers"])]
    sections |= {
        "Steps in order": tables.sequence_tables(every, facts),
        "How calls ended": [tables.outcome_table(first), *tables.failing_clocks(first)],
        "Method": [*method, tables.settings_table(study["settings"])],
        "Limitations": sentences("limitations"),
        "Problems": [tables.problem_table(facts)],
        "Machine, versions, options": places,
    }
    title = "Solvers on contact problems with exact answers"
    return Report(title, tuple(Section(n, tuple(part)) for n, part in sections.items() if part))


def _of_problems(comparison: Comparison, found: Contents, head: str) -> dict[str, Sequence[Block]]:
    """The sections on problems that were solved one at a time."""
    facts = found.problems
    if machines := found.study.get("machines"):
        head += f" Made on {len(machines)} machines: {', '.join(machines)}; "
        head += f"the figures are of {comparison.drawn}."
    soonest = comparison.soonest(WANTED[0])
    families = list(dict.fromkeys(fact["family"] for fact in facts))
    heads = [head, comparison.noise.words]
    return {
        "Time to so many digits": [*heads, *_headline(comparison, found.unreached)],
        "Accuracy and time": _compared(comparison),
        "False claims": [*_claims(comparison), tables.detection(comparison.first)],
        "Worst problems": tables.worst_problems(comparison, facts, comparison.fastest()),
        "By problem family": _by_family(comparison, families),
        "Units, warm starts, interfaces": _contrasts(comparison),
        "Set-up, solving, conversion": tables.parts_of_calls(soonest, comparison.base),
    }


def _headline(comparison: Comparison, unreached: Mapping[str, str]) -> list[Block]:
    there = set(comparison.rows.at(comparison.base)["label"])
    words = [f"{label} was left out: it {reason}." for label, reason in unreached.items()]
    if missing := sorted(set(comparison.rows["label"]) - there):
        names = f"{', '.join(missing)} {'was' if len(missing) == 1 else 'were'}"
        never = filter_words(comparison.base)
        words.append(f"{names} never run with {never}, and cannot be compared.")
    found = [comparison.soonest(least) for least in WANTED]
    return [*words, *(tables.soonest_table(own, comparison) for own in found)]


def _compared(comparison: Comparison) -> list[Block]:
    best = [one.label for one in comparison.fastest()]
    each = [tables.solver_table(comparison, setting) for setting in comparison.settings]
    pictures = _profiles(comparison, best), _successes(comparison, best)
    return [*pictures, _against_time(comparison, best), *each]


def _profiles(comparison: Comparison, best: Sequence[str]) -> Block:
    panels, said = [], []
    for least in PROFILED:
        found = {one.label: one for one in comparison.soonest(least)}
        lines = [found[label] for label in best if label in found]
        if lines:
            times = np.array([one.rows.sorted_by_unit("seconds") for one in lines])
            good = np.array([one.rows.sorted_by_unit("digits") for one in lines])
            ratios = performance_ratios(times, good >= least)
            title = f"right to {least:g} digits"
            labels = [one.label for one in lines]
            panels.append({"title": title, "labels": labels, "ratios": ratios})
            said.append(f"{title}{same_problems(lines[0].rows)}")
    caption = (
        "Performance profiles, of each solver through the interface with the fastest 6 digits."
    )
    words = "; ".join(said) + "; each at the setting of the table of that time"
    return _picture("profiles", panels, caption, comparison.base, words)


def _successes(comparison: Comparison, best: Sequence[str]) -> Block:
    panels, said = [], []
    for setting in comparison.main:
        own = comparison.rows.at(comparison.at(setting)).common()
        right = {
            label: part.sorted_by_unit("digits")
            for (label,), part in own.groups("label").items()
            if label in best
        }
        if right:
            shares = np.array([[success(d, level) for level in LEVELS] for d in right.values()])
            panels.append({"title": setting, "labels": list(right), "shares": shares})
            said.append(f"setting = {setting}{same_problems(own)}")
    words = "Problems solved to 3, 6 and 9 correct digits."
    return _picture("success", panels, words, comparison.base, "; ".join(said), levels=LEVELS)


def _picture(
    name: str, panels: list[Any], caption: str, where: Where, said: str, **more: Any
) -> Block:
    """A picture, or a sentence in place of one that would be empty."""
    if not panels:
        return (
            f"There is no problem that all solvers were run on: the figure `{name}` is not drawn."
        )
    rows = f"{filter_words(where)}; {said}"
    return Picture(name, name, {"panels": panels, **more}, caption, rows)


def _against_time(comparison: Comparison, best: Sequence[str]) -> Block:
    """Digits against time: a line a solver, a mark a setting, all on the same problems."""
    own_ = {s["name"]: s["accuracy"] is None for s in comparison.study["settings"]}
    panels, said = [], []
    for units in sorted(set(comparison.rows["units"])):
        own = comparison.rows.at({**comparison.base, "units": units}).common("label", "setting")
        lines = {
            label: [
                (own_[s], float(np.median(at["seconds"])), float(np.median(at["digits"])))
                for s in comparison.settings
                if (at := part.at(setting=s))
            ]
            for (label,), part in own.groups("label").items()
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
    return _picture("digits_time", panels, caption, where, "; ".join(said))


def _claims(comparison: Comparison) -> list[Block]:
    rows = comparison.rows
    promised = {s["name"]: s["promised"] for s in comparison.study["settings"]}
    found = [
        tables.false_claims(rows, comparison.settings, {"units": units, "warm": warm})
        for units, warm in sorted(rows.groups("units", "warm"))
    ]
    return [tables.claims_sentence(rows), *found, tables.worst_claims(rows, promised)]


def _by_family(comparison: Comparison, families: Sequence[str]) -> list[Block]:
    panels, found, said = [], [], []
    for setting in comparison.main:
        where = comparison.at(setting)
        own = comparison.rows.at(where).common()
        labels, digits = tables.family_digits(own, families)
        if labels:
            more = same_problems(own)
            panel = {"labels": labels, "families": families, "digits": digits}
            panels.append({"title": f"setting {setting}", **panel})
            found.append(tables.family_table(labels, digits, families, where, more))
            said.append(f"setting = {setting}{more}")
    caption = "Median digits delivered, by problem family and solver."
    return [_picture("families", panels, caption, comparison.base, "; ".join(said)), *found]


def _contrasts(comparison: Comparison) -> list[Block]:
    units, cold = {"units": comparison.base["units"]}, {"warm": False}
    ways, raw = ("label", "setting"), ("raw", "natural")
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
