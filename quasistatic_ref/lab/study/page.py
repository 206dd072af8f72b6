"""The page of a study: tables in Markdown and figures, from its rows as pandas has them.

Digits that a call *delivers* are those of its x if the solver says that it solved, and 0 otherwise,
since a simulator cannot go on with an answer that its solver does not stand by.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.markdown import markdown_table
from quasistatic_ref.lab.study.compared import (
    CALLED,
    SHIFT,
    SIX,
    UNSOLVED,
    counted_seconds,
    profile_shares,
    shifted_mean,
    time_ratios,
)
from quasistatic_ref.lab.study.problems.names import NATURAL
from quasistatic_ref.lab.study.row import Row
from quasistatic_ref.lab.study.saying import INFEASIBLE, OTHER, SOLVED
from quasistatic_ref.lab.study.solvers import SETTINGS
from quasistatic_ref.parts import needed_package
from quasistatic_ref.text.content import text_written

PAGE = "summary.md"
ORDER = {setting.name: k for k, setting in enumerate(SETTINGS)}


def page_written(rows: Sequence[Row], folder: Path) -> list[Path]:
    """Write the page and its figures.

    Parameters
    ----------
    rows : sequence of Row
        Of one study, or of several.
    folder : Path

    Raises
    ------
    InputError
        If there are no rows, pandas is not installed, or the folder cannot be written.
    """
    from quasistatic_ref.lab.figures.study import figures_written

    if not rows:
        raise InputError("there are no rows to show; run the study first")
    table = table_of(rows)
    return [
        text_written(folder / PAGE, page(table)),
        *figures_written(folder / "figures", points(table), reached(table), ratios(table)),
    ]


def table_of(rows: Sequence[Row]) -> Any:
    """Rows as pandas has them, with the columns that the tables need.

    Returns
    -------
    pandas.DataFrame
        ``label``; ``delivered`` digits [-], NaN where there is no solution; ``ms`` of a call.
    """
    pandas = needed_package("pandas", "study", "the page of a study")
    table = pandas.DataFrame([asdict(row) for row in rows], columns=list(Row.__annotations__))
    table["label"] = table["door"] + ":" + table["solver"]
    delivered = table["digits"].astype(float).fillna(0.0).where(table["says"] == SOLVED, 0.0)
    table["delivered"] = delivered.where(table["feasible"])
    table["ms"] = 1e3 * table["seconds"].astype(float)
    return table


def page(table: Any) -> str:
    """The page of a :func:`table_of` rows, in Markdown."""
    every = _by_setting(table)
    parts = [
        "# Solvers on problems with exact answers",
        "",
        f"{table['problem'].nunique()} problems, {table['label'].nunique()} pairs of solver and "
        f"door, {len(table):,} calls. Calls in {_natural(table)['units'].iloc[0]} units, unless "
        "a table says otherwise.",
        "",
        "## What solvers say",
        "",
        "**All calls**, by what the solver says, whether its residuals reached the accuracy, if "
        "one was asked for, and whether there is a solution.",
        "",
        *_sayings(table),
        "",
        "## Who solves what",
        "",
        "**Each solver through the door, and at the setting, that most often has 6 digits** on "
        "the problems with a solution.",
        "",
        *_lines(_best(every), options=False),
        "",
        f"The shifted geometric mean is that of qpbenchmark: its shift is {SHIFT:g} s, and a call "
        f"without 6 digits counts as {UNSOLVED:g} s.",
        "",
        "## Performance profile",
        "",
        "**Share of problems [%] that a solver, called as above, solves with 6 digits within a "
        "factor of the time of the fastest** (Dolan and Moré, 2002).",
        "",
        *_profile(table),
        "",
        "## Every setting",
        "",
        *_lines(every, options=True),
        "",
        "## By problem family",
        "",
        "**Median digits that are delivered, at the setting `default`.**",
        "",
        *_families(table),
        "",
        *_units(table),
    ]
    return "\n".join(parts).rstrip() + "\n"


def _natural(table: Any) -> Any:
    """The calls in natural units; those as the numbers stand, if a study has no others."""
    natural = table[table["units"] == NATURAL]
    return natural if len(natural) else table


def _sayings(table: Any) -> list[str]:
    """How often each solver gave each answer: a line for each solver and one for all."""
    asked = _natural(table)
    truth = asked["feasible"].map({True: ", a solution", False: ", no solution"})
    arrived = asked["reached"].map({True: ", reached", False: ", not reached"}).fillna("")
    words = asked["says"] + arrived.where(asked["says"] == SOLVED, "") + truth
    kinds = words.where(asked["says"] != OTHER, OTHER)
    counts = asked.pivot_table("n", "solver", kinds.rename("said"), aggfunc="size", fill_value=0)
    counts.loc["all"] = counts.sum()
    rows = [[name, *(f"{n:,}" for n in line)] for name, *line in counts.itertuples()]
    return markdown_table(["solver", *counts.columns], rows, 1)


def _by_setting(table: Any) -> Any:
    """A table with a line for each solver, interface and setting."""
    solvable = _natural(table)[lambda rows: rows["feasible"]]
    lines = (
        solvable.assign(
            missed=(solvable["says"] == SOLVED) & solvable["reached"].eq(False),
            infeasible=solvable["says"] == INFEASIBLE,
            other=solvable["says"] == OTHER,
            counted=counted_seconds(solvable),
        )
        .groupby(CALLED, sort=False)
        .agg(
            problems=("problem", "nunique"),
            six=("delivered", lambda values: 100 * (values >= SIX).mean()),
            three=("delivered", lambda values: 100 * (values >= SIX / 2).mean()),
            digits=("delivered", "median"),
            ms=("ms", "median"),
            ms_95=("ms", lambda values: values.quantile(0.95)),
            mean=("counted", lambda seconds: 1e3 * shifted_mean(seconds)),
            missed=("missed", "sum"),
            infeasible=("infeasible", "sum"),
            other=("other", "sum"),
        )
        .reset_index()
    )
    lines["order"] = lines["setting"].map(ORDER).fillna(len(ORDER))
    return lines.sort_values(["label", "order"])


def _best(every: Any) -> Any:
    """The best row of each solver: the one that most often has six digits."""
    order = every.sort_values(["six", "ms"], ascending=[False, True])
    return order[~order["label"].str.split(":", n=1).str[-1].duplicated()]


def _lines(every: Any, options: bool) -> list[str]:
    columns = ["solver", "setting", "problems", ">= 6 digits [%]", ">= 3 digits [%]",
               "digits, median", "time, median [ms]", "time, 95 % [ms]", "time, shifted mean [ms]",
               "solved, not reached", "infeasible", "other"]  # fmt: skip
    rows = []
    for one in every.itertuples():
        shares = (_shown(v) for v in (one.six, one.three, one.digits))
        times = (f"{float(f'{v:.3g}'):g}" for v in (one.ms, one.ms_95, one.mean))
        counts = (one.missed, one.infeasible, one.other)
        rows.append([one.label, one.setting, one.problems, *shares, *times, *counts])
        if options:
            rows[-1].append(f"`{one.options}`")
    return markdown_table([*columns, *["options"] * options], rows, 2)


def _shown(value: float) -> str:
    """A number with one decimal; a dash for NaN."""
    return f"{value:.1f}" if value == value else "-"


def _medians(calls: Any, index: str, columns: str, first: str) -> list[str]:
    """A table of median digits that are delivered."""
    medians = calls.pivot_table(
        index=index, columns=columns, values="delivered", aggfunc="median", observed=True
    )
    rows = [
        [name, *map(_shown, line)]
        for name, line in zip(medians.index, medians.to_numpy().tolist(), strict=True)
    ]
    return markdown_table([first, *medians.columns], rows, 1)


def _families(table: Any) -> list[str]:
    natural = _natural(table)
    return _medians(natural[natural["setting"] == "default"], "family", "label", "family")


def _units(table: Any) -> Iterator[str]:
    """Digits of the same calls in SI and in natural units."""
    raw = table[table["units"] != NATURAL]
    both = table[
        table["problem"].isin(raw["problem"])
        & table["label"].isin(raw["label"])
        & (table["setting"] == "tuned")
    ]
    if both["units"].nunique() > 1:
        yield "## By units"
        yield ""
        yield (
            "**Median digits that are delivered, at the setting `tuned`**, of the problems that "
            "were put in both units."
        )
        yield ""
        yield from _medians(both, "label", "units", "solver")


def points(table: Any) -> Any:
    """Median digits and times of each solver, through its best door, at each setting."""
    every = _by_setting(table)
    shown = every["label"].isin(_best(every)["label"]) & (every["ms"] > 0)
    return every[shown][["label", "setting", "order", "digits", "ms", "mean"]]


def ratios(table: Any) -> Any:
    """Times over the fastest of each solver as it has six digits most often, a line a call [-]."""
    solvable = _natural(table)[lambda rows: rows["feasible"]]
    return time_ratios(solvable, _best(_by_setting(table)))


def _profile(table: Any) -> list[str]:
    shares = profile_shares(ratios(table))
    rows = [[name, *map(_shown, line)] for name, *line in shares.itertuples()]
    return markdown_table(["solver", *shares.columns], rows, 1)


def reached(table: Any) -> Any:
    """Digits of answers that reached their accuracy: 5th percentile and median, by family."""
    natural = _natural(table)
    answers = natural[
        (natural["says"] == SOLVED) & natural["reached"].eq(True) & natural["feasible"]
    ]
    ranges = answers.groupby(["family", "setting"])["delivered"].quantile([0.05, 0.5]).unstack()
    ranges = ranges.reset_index().rename(columns={0.05: "low", 0.5: "median"})
    if len(ranges):
        ranges["order"] = ranges["setting"].map(ORDER).fillna(len(ORDER))
        ranges = ranges.sort_values(["order", "family"])
    return ranges
