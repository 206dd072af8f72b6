"""The time that digits take: each solver at the setting that delivers them soonest.

A call that does not deliver them takes the time limit. So a setting is chosen by one number, the
shifted geometric mean of these times, in which a fast setting pays for every problem that it loses.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.study.report.columns import Columns, Where, chosen, common, groups, size
from quasistatic_ref.lab.study.report.noise import Noise
from quasistatic_ref.lab.study.report.numbers import (
    digits,
    filter_words,
    milliseconds,
    options_words,
    percent,
)
from quasistatic_ref.lab.study.report.solver_tables import (
    same_problems,
    solver_cells,
    solver_headings,
)
from quasistatic_ref.lab.study.report.statistics import (
    SHIFT,
    interval,
    resampled,
    shifted_geometric_mean,
    success,
)
from quasistatic_ref.solve.backends import BACKENDS

WANTED = (6.0, 3.0, 9.0, 12.0)
"""Digits for which times are given; the first are those that a simulator's step should have."""
LIMITS = tuple({b.time_limit for b in BACKENDS.values()})
"""Options that are not advice."""


@dataclass(frozen=True, eq=False)
class Soonest:
    """One solver at its setting for so many digits.

    Parameters
    ----------
    label, setting : str
    rows : mapping of str to ndarray
        Its calls there.
    times : ndarray, shape (calls,)
        Of those, the time limit where the digits were not delivered [s].
    least : float
        The digits [-].
    """

    label: str
    setting: str
    rows: Columns
    times: np.ndarray
    least: float

    @property
    def machine(self) -> str:
        """Where its calls were made, if several were merged."""
        return str(self.rows["machine"][0])

    @property
    def mean(self) -> float:
        """Shifted geometric mean of the times [s]."""
        return shifted_geometric_mean(self.times)


def soonest(
    columns: Columns, settings: Sequence[str], where: Where, least: float, limit: float
) -> list[Soonest]:
    """Each solver at the setting that delivers so many digits soonest, the fastest first.

    All are compared on the same problems, at every setting that each was called with.

    Parameters
    ----------
    columns : mapping of str to ndarray
    settings : sequence of str
    where : mapping
    least : float
        Digits [-].
    limit : float
        The time limit [s].
    """
    own = common(chosen(columns, where), ["label", "setting"])
    found = []
    for (label,), part in groups(own, ["label"]):
        options = []
        for setting in settings:
            if size(at := chosen(part, {"setting": setting})):
                times = np.where(at["digits"] >= least, at["seconds"], limit)
                options.append(Soonest(label, setting, at, times, least))
        found.append(min(options, key=lambda option: option.mean))
    return sorted(found, key=lambda one: one.mean)


def soonest_table(
    found: Sequence[Soonest], where: Where, noise: Noise, options: Mapping[str, Any] | None = None
) -> Table:
    """What digits cost, solver by solver.

    Parameters
    ----------
    found : sequence of Soonest
    where : mapping
    noise : Noise
    options : mapping, optional
        Each solver's options by setting, to be shown.
    """
    rows = []
    for one in found:
        good, families = one.rows["digits"] >= one.least, one.rows["family"]
        shares = interval(100 * resampled(good.astype(float), families))
        logs = resampled(np.log(one.times + SHIFT), families)
        span = interval(np.exp(logs) - SHIFT)
        cells = [*solver_cells(one.rows), one.setting]
        if options is not None:
            own = options[str(one.rows["way"][0])][one.setting]
            cells.append(f"`{options_words(own, LIMITS)}`")
        cells += [
            percent(success(one.rows["digits"], one.least)),
            " to ".join(map(percent, shares)),
            digits(float(np.median(one.rows["digits"]))),
            *(
                str(int((one.rows[said] & one.rows["wrong"]).sum()))
                for said in ("said_optimal", "said_infeasible")
            ),
            milliseconds(float(np.median(one.rows["seconds"]))),
            milliseconds(one.mean),
            " to ".join(map(milliseconds, span)),
            _tie(one, found, noise),
        ]
        rows.append(tuple(cells))
    least = found[0].least if found else 0
    first = solver_headings(found[0].rows) if found else ("solver", "interface")
    names = [*first, "setting", *(["its own options"] if options is not None else [])]
    more = same_problems(found[0].rows) if found else ""
    columns = (
        *names, f">= {least:g} digits [%]", "95 % of bootstraps", "digits, median",
        "said optimal, was wrong", "said infeasible, was wrong", "time, median [ms]",
        f"time to {least:g} digits, shifted geometric mean [ms]", "95 % of bootstraps, mean",
        "tie with the fastest",
    )  # fmt: skip
    title = f"Time to {least:g} digits, each solver at the setting that delivers them soonest."
    return Table(title, filter_words(where, more), columns, tuple(rows), left=len(names))


def _tie(one: Soonest, found: Sequence[Soonest], noise: Noise) -> str:
    fastest = next(other for other in found if other.machine == one.machine)
    if one is fastest:
        return "-"
    if noise.floor is None:
        return "not known"
    return "yes" if one.mean <= fastest.mean * (1 + noise.floor) else "no"
