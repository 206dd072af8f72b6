"""The tables of a report on solvers; each carries the filter that gives its rows."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.study.measuring.grade import NOT_RUN, OUTCOMES
from quasistatic_ref.lab.study.report.columns import Columns, Where, chosen, common, groups, size
from quasistatic_ref.lab.study.report.numbers import digits, filter_words, milliseconds, percent
from quasistatic_ref.lab.study.report.statistics import LOW, shifted_geometric_mean, success

LEVELS = (3.0, 6.0, 9.0)
"""Digits at which success is counted."""
WORST = 12
"""How many false claims are shown."""
SHARED = "; on the {} that all these solvers were given; what a budget did not reach is missed"


def solver_table(columns: Columns, where: Where) -> Table:
    """Every solver at one setting, on the same problems: digits, success and time."""
    own = common(chosen(columns, where))
    rows = [
        (
            *solver_cells(part),
            str(size(part)),
            percent(100 * float(part["solved"].mean())),
            *(percent(success(part["digits"], least)) for least in LEVELS),
            digits(float(np.percentile(part["digits"], LOW))),
            digits(float(np.median(part["digits"]))),
            digits(float(np.median(part["net"]))),
            milliseconds(float(np.median(part["seconds"]))),
            milliseconds(shifted_geometric_mean(part["seconds"])),
        )
        for _, part in groups(own, ["label"])
    ]
    return Table(
        f"Setting {where['setting']}, {where['units']} units.",
        filter_words(where, same_problems(own)),
        (*solver_headings(columns), "calls", "solved [%]",
         *(f">= {d:g} digits [%]" for d in LEVELS), "digits, 1st percentile",
         "digits, median", "digits of the net wrench, median", "time, median [ms]",
         "time, shifted geometric mean [ms]"),
        tuple(rows), left=len(solver_headings(columns)),
    )  # fmt: skip


def solver_headings(columns: Columns) -> tuple[str, ...]:
    """The first columns of tables on solvers: the machine is one where several were merged."""
    return ("solver", "interface", *(("machine",) if columns["machine"].any() else ()))


def solver_cells(part: Columns) -> list[str]:
    """What stands in these columns, of rows of one solver."""
    return [str(part[name][0]) for name in solver_headings(part)]


def same_problems(columns: Columns) -> str:
    """How many problems a comparison is on, as the end of a filter."""
    return SHARED.format(f"{len(np.unique(columns['unit'])):,} problems")


def outcome_table(columns: Columns) -> Table:
    """How all calls ended, solver by solver."""
    rows = [
        (label, str(size(part)), *(str(int((part["outcome"] == o).sum())) for o in OUTCOMES))
        for (label,), part in groups(columns, ["label"])
    ]
    words = {NOT_RUN: "not run (budget)"}
    names = tuple(words.get(o, o.replace("_", " ")) for o in OUTCOMES)
    return Table("How the calls ended.", "repetition = 0", ("solver", "calls", *names), tuple(rows))


def false_claims(columns: Columns, settings: Sequence[str], where: Where) -> Table:
    """What was claimed wrongly: optimal, infeasible, multipliers; of how many claims of success."""
    rows = []
    for (label,), part in groups(chosen(columns, where), ["label"]):
        cells = []
        for setting in settings:
            own = chosen(part, {"setting": setting})
            said = own["said_optimal"]
            counts = (own["wrong"] & said, own["wrong"] & own["said_infeasible"],
                      own["wrong_multipliers"])  # fmt: skip
            words = " + ".join(str(int(count.sum())) for count in counts)
            cells.append(f"{words} / {int(said.sum())}" if size(own) else "-")
        rows.append((label, *cells))
    units, way = where["units"], "warm" if where["warm"] else "cold"
    return Table(
        "False claims of success + false claims of infeasibility + wrong multipliers / all claims "
        f"of success: {units} units, {way}.",
        filter_words(where),
        ("solver", *settings),
        tuple(rows),
    )


def worst_claims(columns: Columns, promised: Mapping[str, float]) -> Table:
    """The false claims with the fewest digits of those promised, one of each kind of call.

    Parameters
    ----------
    columns : mapping of str to ndarray
    promised : mapping of str to float
        Digits, by setting [-].
    """
    wrong = chosen(columns, {"wrong": True})
    worst = [
        {name: part[name][np.argmin(part["digits"])] for name in part}
        for _, part in groups(wrong, ["label", "setting", "units", "warm"])
    ]
    worst.sort(key=lambda row: float(row["digits"] - promised[str(row["setting"])]))
    rows = tuple(
        (
            str(row["label"]), str(row["setting"]), str(row["units"]),
            str(bool(row["warm"])).lower(), str(row["problem"]), str(row["claimed"]),
            digits(promised[str(row["setting"])]), digits(float(row["digits"])),
        )
        for row in worst[:WORST]
    )  # fmt: skip
    names = ("solver", "setting", "units", "warm", "problem", "its own status",
             "digits promised", "digits")  # fmt: skip
    return Table("The false claims that fall furthest short of the digits promised, one for each "
                 "solver, setting, units, and warm or cold start.", "wrong = true", names, rows,
                 left=6)  # fmt: skip


def contrast(
    columns: Columns,
    settings: Sequence[str],
    title: str,
    by: str,
    values: Sequence[Any],
    where: Where,
    ways: Sequence[str] = ("who", "setting"),
    iterations: bool = False,
) -> Table:
    """One field at two or more values, each solver and setting on the same problems.

    Parameters
    ----------
    columns : mapping of str to ndarray
    settings : sequence of str
    title : str
    by : str
        The field; ``interface`` compares a solver with itself, too.
    values : sequence
    where : mapping
    ways : sequence of str
        What a line is about: a solver (``who``), or a solver with its interface (``label``,
        ``way``), and a setting.
    iterations : bool
        Whether to add columns of the median number of iterations.
    """
    rows = []
    every = dict(groups(chosen(columns, where), ways))
    solvers = dict.fromkeys(solver for solver, _ in every)
    for key in ((solver, setting) for solver in solvers for setting in settings):
        if key not in every:
            continue
        part = every[key]
        own = common(part, [by])
        parts = [chosen(own, {by: value}) for value in values]
        if not all(map(size, parts)):
            continue
        cells: list[str] = [*key, str(len(np.unique(own["unit"])))]
        cells += [percent(success(p["digits"], 6.0)) for p in parts]
        cells += [milliseconds(float(np.median(p["seconds"]))) for p in parts]
        if iterations:
            cells += [_median_known(p["iterations"]) for p in parts]
        rows.append(tuple(cells))
    names = [filter_words({by: value}) for value in values]
    columns_ = ["solver", "setting", "problems"]
    columns_ += [f">= 6 digits [%], {name}" for name in names]
    columns_ += [f"time, median [ms], {name}" for name in names]
    if iterations:
        columns_ += [f"iterations, median, {name}" for name in names]
    said = f"; each line is on the problems with a call at every value of {by}"
    return Table(title, filter_words(where, said), tuple(columns_), tuple(rows), left=2)


def family_digits(
    columns: Columns, where: Where, families: Iterable[str]
) -> tuple[list[str], np.ndarray]:
    """Median digits delivered, of every solver on every family.

    Returns
    -------
    list of str
        The solvers.
    ndarray, shape (solvers, families) [-]
        NaN where there is no problem.
    """
    own = common(chosen(columns, where))
    labels = [label for (label,), _ in groups(own, ["label"])]
    names = list(families)
    found = np.full((len(labels), len(names)), np.nan)
    for (label, family), part in groups(own, ["label", "family"]):
        found[labels.index(label), names.index(family)] = float(np.median(part["digits"]))
    return labels, found


def family_table(
    labels: Sequence[str], found: np.ndarray, where: Where, families: Sequence[str], more: str
) -> Table:
    """The numbers of the heat map.

    Parameters
    ----------
    labels : sequence of str
    found : ndarray, shape (solvers, families) [-]
    where : mapping
    families : sequence of str
    more : str
        The end of the filter.
    """
    rows = tuple(
        (family, *("-" if np.isnan(v) else digits(float(v)) for v in column))
        for family, column in zip(families, found.T, strict=True)
    )
    title = f"Median digits by family, setting {where['setting']}."
    return Table(title, filter_words(where, more), ("family", *labels), rows)


def problem_table(facts: Sequence[Mapping[str, Any]]) -> Table:
    """What the problems are."""
    families = list(dict.fromkeys(fact["family"] for fact in facts))
    rows = []
    for family in families:
        own = [fact for fact in facts if fact["family"] == family]
        cells = [family, str(len(own)), str(sum(f["kind"] == "exact" for f in own))]
        for name in ("n", "m", "contacts", "h", "mass_ratio", "condition", "condition_natural"):
            values = [f[name] for f in own if f[name] is not None]
            cells.append(_span(values))
        rows.append(tuple(cells))
    names = ("family", "problems", "exact answers", "coordinates n", "rows m", "contacts",
             "h [s]", "mass ratio", "condition of H, raw", "condition of H, natural")  # fmt: skip
    return Table("The problems.", "the store, problems", names, tuple(rows))


def _span(values: Sequence[float]) -> str:
    if not values:
        return "-"
    ends = (min(values), max(values))
    low, high = (f"{v:.0f}" if 10 <= v < 1e4 else f"{v:.2g}" for v in ends)
    return low if low == high else f"{low} to {high}"


def _median_known(values: np.ndarray) -> str:
    known = values[np.isfinite(values)]
    return f"{np.median(known):g}" if len(known) else "-"
