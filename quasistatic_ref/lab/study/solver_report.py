"""The report on solvers: which one, at which setting, how right, how fast, where it fails."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.advice import advice, advice_table, options_table
from quasistatic_ref.lab.study.columns import (
    Columns,
    chosen,
    columns_of,
    common,
    groups,
    matrix,
    size,
)
from quasistatic_ref.lab.study.page import Block, Picture, Report, Section, filter_words
from quasistatic_ref.lab.study.report_words import (
    LIMITATIONS,
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
    settings = _settings(study, columns)
    base = _widest(columns)
    main = _main_settings(columns, settings, base)
    families = list(dict.fromkeys(fact["family"] for fact in facts))
    promised = {s["name"]: s["promised"] for s in study["settings"]}
    head = (
        f"{len(facts):,} problems, {len(set(columns['label'])):,} solvers by road, "
        f"{len(rows):,} measurements."
    )
    return Report(
        "Solvers on contact problems with exact answers",
        (
            Section("Which settings to use", (head, *_advised(study, columns, settings, base))),
            Section("Accuracy and time", tuple(_compared(study, columns, settings, main, base))),
            Section("Said optimal, was wrong", tuple(_claims(columns, settings, promised))),
            Section("By problem family", tuple(_by_family(columns, main, base, families))),
            Section("Units, warm starts, roads", tuple(_contrasts(columns, settings, base))),
            Section("How calls ended", (outcome_table(columns),)),
            Section("Method", (*method(study["time_limit"]), settings_table(study["settings"]))),
            Section("Limitations", LIMITATIONS),
            Section("Problems", (problem_table(facts),)),
            Section("Machine, versions, options",
                    (*place_tables(study), options_table(study["solvers"]))),
        ),
    )  # fmt: skip


def _settings(study: Mapping[str, Any], columns: Columns) -> list[str]:
    """The settings that were asked, each solver's own first, then from loose to tight."""
    asked = [s for s in study["settings"] if s["name"] in set(columns["setting"])]
    asked.sort(key=lambda s: -np.inf if s["accuracy"] is None else -s["accuracy"])
    return [s["name"] for s in asked]


def _widest(columns: Columns) -> dict[str, str | bool]:
    """The road, units and warmth that most calls were made with: what is compared first."""
    most = max(groups(columns, ["road", "units", "warm"]), key=lambda one: size(one[1]))
    road, units, warm = most[0]
    return {"road": road, "units": units, "warm": warm == "True"}


def _main_settings(
    columns: Columns, settings: Sequence[str], base: Mapping[str, str | bool]
) -> list[str]:
    """The settings, at most two, at which most problems were asked."""
    counts = {s: size(chosen(columns, {**base, "setting": s})) for s in settings}
    two = sorted(settings, key=lambda s: -counts[s])[:2]
    return [s for s in settings if s in two and counts[s]]


def _advised(
    study: Mapping[str, Any],
    columns: Columns,
    settings: Sequence[str],
    base: Mapping[str, str | bool],
) -> list[Block]:
    found, more = advice(columns, settings, base)
    return [
        "For each solver the setting that delivers 6 digits most often; of settings within 1 % of "
        "that, the one with the least shifted geometric mean of times. Surest first.",
        advice_table(found, study["solvers"], base, more),
    ]


def _compared(
    study: Mapping[str, Any],
    columns: Columns,
    settings: Sequence[str],
    main: Sequence[str],
    base: Mapping[str, str | bool],
) -> list[Block]:
    where = filter_words(base)
    panels, shares, said = [], [], []
    for setting in main:
        own = common(chosen(columns, {**base, "setting": setting}))
        labels = [label for (label,), _ in groups(own, ["label"])]
        if not labels:
            continue
        good = matrix(own, "digits", labels)
        ratios = performance_ratios(matrix(own, "seconds", labels), good >= NEEDED.get(setting, 6))
        title = f"{setting}: right to {NEEDED.get(setting, 6):g} digits"
        panels.append({"title": title, "labels": labels, "ratios": ratios})
        found = np.array([[success(d, least) for least in LEVELS] for d in good])
        shares.append({"title": setting, "labels": labels, "shares": found})
        said.append(f"setting = {setting}{same_problems(own)}")
    rows = f"{where}; {'; '.join(said)}"
    blocks: list[Block] = [
        Picture("profiles", "profiles", {"panels": panels}, "Performance profiles.", rows),
        Picture("success", "success", {"panels": shares, "levels": LEVELS},
                "Problems solved to 3, 6 and 9 correct digits.", rows),
        _against_time(study, columns, settings, base),
    ]  # fmt: skip
    tables = [solver_table(columns, {**base, "setting": s}) for s in settings]
    return [*map(_drawable, blocks), *tables]


def _drawable(block: Block) -> Block:
    """A picture, or a sentence in place of one that would be empty."""
    if isinstance(block, Picture) and not block.data["panels"]:
        return f"No problem was asked of all solvers: nothing to draw of `{block.name}`."
    return block


def _against_time(
    study: Mapping[str, Any],
    columns: Columns,
    settings: Sequence[str],
    base: Mapping[str, str | bool],
) -> Picture:
    """Digits against time: a line a solver, a mark a setting, all on the same problems."""
    own_ = {s["name"]: s["accuracy"] is None for s in study["settings"]}
    panels, said = [], []
    for units in sorted(set(columns["units"])):
        where = {**base, "units": units}
        own = common(chosen(columns, where), ["label", "setting"])
        lines = {
            label: [
                (own_[s], float(np.median(at["seconds"])), float(np.median(at["digits"])))
                for s in settings
                if size(at := chosen(part, {"setting": s}))
            ]
            for (label,), part in groups(own, ["label"])
        }
        if lines:
            panels.append({"title": f"{units} units", "lines": lines})
            said.append(f"units = {units}{same_problems(own)}")
    where_ = {name: value for name, value in base.items() if name != "units"}
    caption = (
        "Median digits against median time of a call. A mark is a setting: half filled the "
        "solver's own, filled the tightest; a line joins the others from loose to tight."
    )
    words = f"{filter_words(where_)}; {'; '.join(said)}"
    return Picture("digits_time", "digits_time", {"panels": panels}, caption, words)


def _claims(
    columns: Columns, settings: Sequence[str], promised: Mapping[str, float]
) -> list[Block]:
    tables = [
        false_claims(columns, settings, {"units": units, "warm": warm == "True"})
        for (units, warm), _ in sorted(groups(columns, ["units", "warm"]), key=lambda one: one[0])
    ]
    words = f"{int(columns['wrong'].sum()):,} of {int(columns['said_optimal'].sum()):,} claims"
    return [f"{words} of success are false.", *tables, worst_claims(columns, promised)]


def _by_family(
    columns: Columns,
    main: Sequence[str],
    base: Mapping[str, str | bool],
    families: Sequence[str],
) -> list[Block]:
    panels, tables, said = [], [], []
    for setting in main:
        where = {**base, "setting": setting}
        labels, found = family_digits(columns, where, families)
        more = same_problems(common(chosen(columns, where)))
        if not labels:
            continue
        panels.append(
            {"title": f"setting {setting}", "labels": labels, "families": families, "digits": found}
        )
        tables.append(family_table(labels, found, where, families, more))
        said.append(f"setting = {setting}{more}")
    caption = "Median digits delivered, by problem family and solver."
    rows = f"{filter_words(base)}; {'; '.join(said)}"
    picture = Picture("families", "families", {"panels": panels}, caption, rows)
    return [_drawable(picture), *tables]


def _contrasts(
    columns: Columns, settings: Sequence[str], base: Mapping[str, str | bool]
) -> list[Block]:
    road, units = base["road"], base["units"]
    asked = (
        ("Raw units and natural units.", "units", ("raw", "natural"),
         {"road": road, "warm": False}, False),
        ("Cold and warm starts.", "warm", (False, True), {"road": road, "units": units}, True),
        ("Directly and through CVXPY.", "road", ("qpsolvers", "cvxpy"),
         {"units": units, "warm": False}, False),
    )  # fmt: skip
    tables = [contrast(columns, settings, *one) for one in asked]
    return [table for table in tables if table.rows]
