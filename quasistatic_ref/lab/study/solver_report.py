"""The report on solvers: which one, at which setting, how right, how fast, where it fails."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Block, Picture, Report, Section
from quasistatic_ref.lab.study.advice import advice, advice_table, options_table
from quasistatic_ref.lab.study.columns import (
    Columns,
    Where,
    chosen,
    columns_of,
    common,
    groups,
    matrix,
    size,
)
from quasistatic_ref.lab.study.page import filter_words
from quasistatic_ref.lab.study.report_words import (
    limitations,
    method,
    place_tables,
    settings_table,
)
from quasistatic_ref.lab.study.solver_tables import (
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
from quasistatic_ref.lab.study.statistics import performance_ratios, success
from quasistatic_ref.lab.study.store import Row

NEEDED = {"default": 3.0, "low": 1.0, "mid": 3.0, "high": 6.0, "tuned": 9.0}
"""Digits that count as right in a profile, by setting."""


@dataclass(frozen=True, eq=False)
class _Asked:
    """What a study asked, and the calls that are compared first.

    Parameters
    ----------
    study : mapping
        ``study.json``.
    columns : mapping of str to ndarray
    settings : list of str
        Each solver's own first, then from loose to tight.
    base : mapping
        The interface, units and warmth that most calls were made with.
    """

    study: Mapping[str, Any]
    columns: Columns
    settings: list[str]
    base: Where

    def at(self, setting: str) -> Where:
        """The calls at one setting, of those that are compared first."""
        return {**self.base, "setting": setting}

    @property
    def main(self) -> list[str]:
        """The settings, at most two, at which most problems were asked."""
        counts = {s: size(chosen(self.columns, self.at(s))) for s in self.settings}
        two = sorted(self.settings, key=lambda s: -counts[s])[:2]
        return [s for s in self.settings if s in two and counts[s]]


def solver_report(
    study: Mapping[str, Any], facts: Sequence[Mapping[str, Any]], rows: Sequence[Row]
) -> Report:
    """The report on a store of solvers.

    Parameters
    ----------
    study : mapping
        ``study.json``.
    facts : sequence of mapping
        ``problems.jsonl``.
    rows : sequence of dict

    Returns
    -------
    Report
    """
    columns = columns_of(rows, study["time_limit"])
    asked = _Asked(study, columns, _settings(study, columns), _widest(columns))
    families = list(dict.fromkeys(fact["family"] for fact in facts))
    head = (
        f"{len(facts):,} problems, {len(set(columns['label'])):,} pairs of solver and interface, "
        f"{len(rows):,} measurements."
    )
    options = options_table(study["solvers"])
    sections: dict[str, Sequence[Block]] = {
        "Which settings to use": [head, *_advised(asked)],
        "Accuracy and time": _compared(asked),
        "Said optimal, was wrong": _claims(asked),
        "By problem family": _by_family(asked, families),
        "Units, warm starts, interfaces": _contrasts(asked),
        "How calls ended": [outcome_table(columns)],
        "Method": [*method(study["time_limit"]), settings_table(study["settings"])],
        "Limitations": limitations(),
        "Problems": [problem_table(facts)],
        "Machine, versions, options": [*place_tables(study), options],
    }
    title = "Solvers on contact problems with exact answers"
    return Report(title, tuple(Section(name, tuple(part)) for name, part in sections.items()))


def _settings(study: Mapping[str, Any], columns: Columns) -> list[str]:
    """The settings that were asked, each solver's own first, then from loose to tight."""
    asked = [s for s in study["settings"] if s["name"] in set(columns["setting"])]
    asked.sort(key=lambda s: -np.inf if s["accuracy"] is None else -s["accuracy"])
    return [s["name"] for s in asked]


def _widest(columns: Columns) -> Where:
    """The interface, units and warmth that most calls were made with: what is compared first."""
    most = max(groups(columns, ["interface", "units", "warm"]), key=lambda one: size(one[1]))
    interface, units, warm = most[0]
    return {"interface": interface, "units": units, "warm": warm == "True"}


def _advised(asked: _Asked) -> list[Block]:
    found, more = advice(asked.columns, asked.settings, asked.base)
    return [
        "For each solver the setting that delivers 6 digits most often; of settings within 1 % of "
        "that, the one with the least shifted geometric mean of times. Surest first.",
        advice_table(found, asked.study["solvers"], asked.base, more),
    ]


def _compared(asked: _Asked) -> list[Block]:
    panels, shares, said = [], [], []
    for setting in asked.main:
        own = common(chosen(asked.columns, asked.at(setting)))
        labels = [label for (label,), _ in groups(own, ["label"])]
        if not labels:
            continue
        good, needed = matrix(own, "digits", labels), NEEDED.get(setting, 6)
        ratios = performance_ratios(matrix(own, "seconds", labels), good >= needed)
        title = f"{setting}: right to {needed:g} digits"
        panels.append({"title": title, "labels": labels, "ratios": ratios})
        found = np.array([[success(d, least) for least in LEVELS] for d in good])
        shares.append({"title": setting, "labels": labels, "shares": found})
        said.append(f"setting = {setting}{same_problems(own)}")
    rows = f"{filter_words(asked.base)}; {'; '.join(said)}"
    words, levels = "Problems solved to 3, 6 and 9 correct digits.", {"levels": LEVELS}
    return [
        _picture("profiles", panels, "Performance profiles.", rows),
        _picture("success", shares, words, rows, **levels),
        _against_time(asked),
        *(solver_table(asked.columns, asked.at(setting)) for setting in asked.settings),
    ]


def _picture(name: str, panels: list[Any], caption: str, where: str, **more: Any) -> Block:
    """A picture, or a sentence in place of one that would be empty."""
    if not panels:
        return f"No problem was asked of all solvers: nothing to draw of `{name}`."
    return Picture(name, name, {"panels": panels, **more}, caption, where)


def _against_time(asked: _Asked) -> Block:
    """Digits against time: a line a solver, a mark a setting, all on the same problems."""
    own_ = {s["name"]: s["accuracy"] is None for s in asked.study["settings"]}
    panels, said = [], []
    for units in sorted(set(asked.columns["units"])):
        own = common(chosen(asked.columns, {**asked.base, "units": units}), ["label", "setting"])
        lines = {
            label: [
                (own_[s], float(np.median(at["seconds"])), float(np.median(at["digits"])))
                for s in asked.settings
                if size(at := chosen(part, {"setting": s}))
            ]
            for (label,), part in groups(own, ["label"])
        }
        if lines:
            panels.append({"title": f"{units} units", "lines": lines})
            said.append(f"units = {units}{same_problems(own)}")
    where = {name: value for name, value in asked.base.items() if name != "units"}
    caption = (
        "Median digits against median time of a call. A mark is a setting: half filled the "
        "solver's own, filled the tightest; a line joins the others from loose to tight."
    )
    return _picture("digits_time", panels, caption, f"{filter_words(where)}; {'; '.join(said)}")


def _claims(asked: _Asked) -> list[Block]:
    columns = asked.columns
    promised = {s["name"]: s["promised"] for s in asked.study["settings"]}
    tables = [
        false_claims(columns, asked.settings, {"units": units, "warm": warm == "True"})
        for (units, warm), _ in sorted(groups(columns, ["units", "warm"]), key=lambda one: one[0])
    ]
    words = f"{int(columns['wrong'].sum()):,} of {int(columns['said_optimal'].sum()):,} claims"
    return [f"{words} of success are false.", *tables, worst_claims(columns, promised)]


def _by_family(asked: _Asked, families: Sequence[str]) -> list[Block]:
    panels, tables, said = [], [], []
    for setting in asked.main:
        where = asked.at(setting)
        labels, found = family_digits(asked.columns, where, families)
        more = same_problems(common(chosen(asked.columns, where)))
        if not labels:
            continue
        panel = {"labels": labels, "families": families, "digits": found}
        panels.append({"title": f"setting {setting}", **panel})
        tables.append(family_table(labels, found, where, families, more))
        said.append(f"setting = {setting}{more}")
    caption = "Median digits delivered, by problem family and solver."
    rows = f"{filter_words(asked.base)}; {'; '.join(said)}"
    return [_picture("families", panels, caption, rows), *tables]


def _contrasts(asked: _Asked) -> list[Block]:
    interface, units = {"interface": asked.base["interface"]}, {"units": asked.base["units"]}
    cold, columns = {"warm": False}, (asked.columns, asked.settings)
    directly, raw = ("qpsolvers", "cvxpy"), ("raw", "natural")
    tables = (
        contrast(*columns, "Raw units and natural units.", "units", raw, interface | cold),
        contrast(*columns, "Cold and warm starts.", "warm", (False, True), interface | units, True),
        contrast(*columns, "Directly and through CVXPY.", "interface", directly, units | cold),
    )
    return [table for table in tables if table.rows]
