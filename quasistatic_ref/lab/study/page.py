"""The page of a study: tables in Markdown and two figures, from its rows as pandas has them.

Digits that a call *delivers* are those of its answer if the solver says that it solved, and 0
otherwise, since a simulator cannot go on with the answer of a solver that failed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.study.claims import INFEASIBLE, OPTIMAL
from quasistatic_ref.lab.study.row import MEMORY, NOT_RUN, SOLVED, TIMEOUT, Row
from quasistatic_ref.lab.study.solvers import SETTINGS
from quasistatic_ref.parts import needed_package

PAGE = "summary.md"
SIX = 6.0
"""Correct digits that a simulation wants [-]."""
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
        *figures_written(folder / "figures", points(table), kept(table)),
    ]


def table_of(rows: Sequence[Row]) -> Any:
    """Rows as pandas has them, with the columns that the tables need.

    Returns
    -------
    pandas.DataFrame
        ``label``; ``delivered`` digits [-], NaN where there is no solution; ``ms`` of the first
        call, or of the limit where it was ended.
    """
    pandas = needed_package("pandas", "study", "the page of a study")
    table = pandas.DataFrame([asdict(row) for row in rows], columns=list(Row.__annotations__))
    table["label"] = table["door"] + ":" + table["solver"]
    solved = table["outcome"] == SOLVED
    table["delivered"] = table["digits"].where(solved, 0.0).where(table["feasible"]).astype(float)
    table["ms"] = 1e3 * table["seconds_first"].astype(float)
    return table


def page(table: Any) -> str:
    """The page of a :func:`table_of` rows, in Markdown."""
    parts: list[str] = ["# Solvers on contact problems with exact answers", ""]
    parts += ["## Who solves what", "", *_counted(table), ""]
    every = _by_setting(table)
    parts += [
        "**Each solver through the door, and at the setting, that most often has 6 digits** on "
        "these same problems. Natural units, cold; calls that a budget did not reach are left out.",
        "",
        *_lines(_best(every), options=False),
        "",
        "## Every setting",
        "",
        *_lines(every, options=True),
        "",
        "## By problem family",
        "",
        "**Median digits that are delivered, at the setting `default`.** Natural units, cold.",
        "",
        *_families(table),
        "",
    ]
    parts += _in_order(table)
    return "\n".join(parts).rstrip() + "\n"


def _base(table: Any) -> Any:
    """Natural units, cold, and reached by the budget."""
    return table[
        (table["units"] == "natural") & (table["start"] == "cold") & (table["outcome"] != NOT_RUN)
    ]


def _counted(table: Any) -> Iterator[str]:
    """How much was measured, and how many claims are false."""
    yield (
        f"{table['problem'].nunique()} problems, {table['label'].nunique()} pairs of solver and "
        f"door, {len(table):,} measurements."
    )
    yield ""
    claims = {
        "of success, where there is a solution": (OPTIMAL, True),
        "of success, where there is none": (OPTIMAL, False),
        "that there is no solution, where there is one": (INFEASIBLE, True),
    }
    lines = []
    for words, (claim, feasible) in claims.items():
        made = table[(table["claim"] == claim) & (table["feasible"] == feasible)]
        false = made[made["false_claim"]]["solver"].value_counts()
        whose = ", ".join(f"{name} {count}" for name, count in false.items())
        lines.append((words, f"{len(made):,}", f"{len(made[made['false_claim']]):,}", whose or "-"))
    yield from markdown_table(("claims", "number", "false", "of which"), lines)


def _by_setting(table: Any) -> Any:
    """A line for each solver, door and setting."""
    base = _base(table)
    solvable = base[base["feasible"]]
    keys = ["label", "setting", "options"]
    lines = solvable.groupby(keys, sort=False).agg(
        problems=("problem", "nunique"),
        six=("delivered", lambda values: 100 * (values >= SIX).mean()),
        three=("delivered", lambda values: 100 * (values >= SIX / 2).mean()),
        digits=("delivered", "median"),
        digits_lam=("digits_lam", "median"),
        ms=("ms", "median"),
        ms_95=("ms", lambda values: values.quantile(0.95)),
        ms_again=("seconds", lambda values: 1e3 * values.median()),
        ended=("outcome", lambda values: values.isin((TIMEOUT, MEMORY)).sum()),
        failed=("outcome", lambda values: (values != SOLVED).sum()),
        infeasible=("claim", lambda values: (values == INFEASIBLE).sum()),
    )
    false = base.groupby(keys, sort=False)["false_claim"].sum()
    lines = lines.join(false).reset_index()
    lines["order"] = lines["setting"].map(ORDER).fillna(len(ORDER))
    return lines.sort_values(["label", "order"])


def _best(every: Any) -> Any:
    """Of each solver, whatever its door, the line that most often has six digits."""
    order = every.sort_values(["six", "ms"], ascending=[False, True])
    return order[~order["label"].str.partition(":")[2].duplicated()]


def _lines(every: Any, options: bool) -> list[str]:
    columns = ["solver", "setting", "problems", ">= 6 digits [%]", ">= 3 digits [%]",
               "digits, median", "digits of multipliers", "time, median [ms]", "time, 95 % [ms]",
               "repeated, median [ms]", "false claims", "failed", "of these ended",
               "called infeasible"]  # fmt: skip
    rows = []
    for one in every.itertuples():
        times = (f"{v:.3g}" for v in (one.ms, one.ms_95, one.ms_again))
        shares = (_shown(v) for v in (one.six, one.three, one.digits, one.digits_lam))
        rows.append([one.label, one.setting, one.problems, *shares, *times, one.false_claim,
                     one.failed, one.ended, one.infeasible])  # fmt: skip
        if options:
            rows[-1].append(f"`{one.options}`")
    return markdown_table([*columns, *["options"] * options], rows, 2)


def _shown(value: float) -> str:
    """A number, or a line where there is none."""
    return f"{value:.1f}" if value == value else "-"


def _families(table: Any) -> list[str]:
    base = _base(table)
    default = base[base["setting"] == "default"]
    medians = default.pivot_table(
        index="family", columns="label", values="delivered", aggfunc="median", observed=True
    )
    rows = [
        [family, *map(_shown, line)]
        for family, line in zip(medians.index, medians.to_numpy().tolist(), strict=True)
    ]
    return markdown_table(["family", *medians.columns], rows, 1)


def _in_order(table: Any) -> list[str]:
    """What a start from an answer is worth: of the same problems, cold and with it."""
    solved = table[table["outcome"] == SOLVED]
    warm = solved[solved["started"]]
    cold = solved[solved["start"] == "cold"]
    keys = ["problem", "label", "setting", "units"]
    both = warm.merge(cold, on=keys, suffixes=("_warm", "_cold"))
    if not len(both):
        return []
    both["ratio"] = both["seconds_warm"].astype(float) / both["seconds_cold"].astype(float)
    lines = both.groupby(["label", "setting", "units", "start_warm"]).agg(
        calls=("ratio", "size"),
        cold=("seconds_cold", lambda values: 1e3 * values.median()),
        warm=("seconds_warm", lambda values: 1e3 * values.median()),
        ratio=("ratio", "median"),
        digits_cold=("digits_cold", "median"),
        digits_warm=("digits_warm", "median"),
    )
    rows = [
        [*one.Index, one.calls, f"{one.cold:.3g}", f"{one.warm:.3g}", f"{one.ratio:.2f}",
         f"{one.digits_cold:.1f}", f"{one.digits_warm:.1f}"]
        for one in lines.itertuples()
    ]  # fmt: skip
    columns = ["solver", "setting", "units", "start", "calls", "cold, median [ms]",
               "with a start, median [ms]", "ratio, median", "digits, cold",
               "digits, with a start"]  # fmt: skip
    return [
        "## Starts from an answer",
        "",
        "**Calls that start from an answer, and the same calls cold.** Both were solved.",
        "",
        *markdown_table(columns, rows, 4),
    ]


def points(table: Any) -> Any:
    """Median digits and time of each solver, through its best door, at each setting."""
    every = _by_setting(table)
    shown = every["label"].isin(_best(every)["label"]) & (every["ms"] > 0)
    return every[shown][["label", "setting", "digits", "ms"]]


def kept(table: Any) -> Any:
    """Digits of answers that kept their promise: 5th percentile and median, by family."""
    base = _base(table)
    answers = base[(base["outcome"] == SOLVED) & base["feasible"] & ~base["false_claim"]]
    answers = answers[answers["setting"] != "default"]
    ranges = answers.groupby(["family", "setting"])["digits"].quantile([0.05, 0.5]).unstack()
    ranges = ranges.reset_index().rename(columns={0.05: "low", 0.5: "median"})
    if len(ranges):
        ranges["order"] = ranges["setting"].map(ORDER).fillna(len(ORDER))
        ranges = ranges.sort_values(["order", "family"])
    return ranges
