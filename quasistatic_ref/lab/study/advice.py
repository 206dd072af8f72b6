"""Which setting to use: each solver's fastest of those that are about as right as its best."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.study.columns import Columns, Where, chosen, common, groups, size
from quasistatic_ref.lab.study.page import (
    digits,
    filter_words,
    milliseconds,
    options_words,
    percent,
)
from quasistatic_ref.lab.study.solver_tables import same_problems
from quasistatic_ref.lab.study.statistics import shifted_geometric_mean, success
from quasistatic_ref.solve.backends import BACKENDS

WANTED = 6.0
"""Digits that a simulator's step should have."""
LIMITS = tuple({b.time_limit for b in BACKENDS.values()})
"""Options that are not advice."""
ABOUT = 1.0
"""Shares that differ by no more are about the same [%]."""


@dataclass(frozen=True)
class Advice:
    """One solver at its best setting.

    Parameters
    ----------
    label : str
    setting : str
    share : float
        Of problems to six digits [%].
    median : float
        Of the digits delivered [-].
    wrong : int
    typical, mean : float
        Median and shifted geometric mean of the times [s].
    """

    label: str
    setting: str
    share: float
    median: float
    wrong: int
    typical: float
    mean: float


def advice(columns: Columns, settings: Sequence[str], where: Where) -> tuple[list[Advice], str]:
    """The best setting of each solver, all compared on the same problems.

    Returns
    -------
    list of Advice
        The surest first; among equals the fastest.
    str
        The end of the filter.
    """
    own = common(chosen(columns, where), ["label", "setting"])
    found = []
    for (label,), part in groups(own, ["label"]):
        options = [
            Advice(
                label,
                setting,
                success(at["digits"], WANTED),
                float(np.median(at["digits"])),
                int(at["wrong"].sum()),
                float(np.median(at["seconds"])),
                shifted_geometric_mean(at["seconds"]),
            )
            for setting in settings
            if size(at := chosen(part, {"setting": setting}))
        ]
        best = max(option.share for option in options)
        near = [option for option in options if option.share >= best - ABOUT]
        found.append(min(near, key=lambda option: option.mean))
    found.sort(key=lambda a: (-round(a.share), a.mean))
    return found, same_problems(own)


def advice_table(
    found: Sequence[Advice],
    solvers: Sequence[Mapping[str, Any]],
    where: Where,
    more: str,
) -> Table:
    """The advice with the options in each solver's own names."""
    options = {f"{s['interface']}:{s['name']}": s["options"] for s in solvers}
    rows = tuple(
        (
            a.label,
            a.setting,
            f"`{options_words(options[a.label][a.setting], LIMITS)}`",
            percent(a.share),
            digits(a.median),
            str(a.wrong),
            milliseconds(a.typical),
            milliseconds(a.mean),
        )
        for a in found
    )
    names = ("solver", "setting", "its own options", f">= {WANTED:g} digits [%]",
             "digits, median", "said optimal, was wrong", "time, median [ms]",
             "time, shifted geometric mean [ms]")  # fmt: skip
    title = f"The setting to use, if a step is to have {WANTED:g} digits."
    return Table(title, filter_words(where, more), names, rows, left=3)


def options_table(solvers: Sequence[Mapping[str, Any]]) -> Table:
    """Every solver's options at every setting."""
    rows = tuple(
        (f"{s['interface']}:{s['name']}", setting, f"`{options_words(options)}`")
        for s in solvers
        for setting, options in s["options"].items()
    )
    return Table("Options.", "study.json, solvers", ("solver", "setting", "its own options"), rows,
                 left=3)  # fmt: skip
