"""What a report on solvers compares: each at the setting that delivers 6 digits soonest.

A call that does not deliver them takes the time limit. So a setting is chosen by one number, the
shifted geometric mean of these times, in which a fast setting pays for every problem that it loses.
It is chosen on one half of the problems and judged on the other; a run is in one half only. Calls
that a budget never reached are in neither.
"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.calling.claims import hides
from quasistatic_ref.lab.study.report.rows import Rows, Where
from quasistatic_ref.lab.study.report.statistics import shifted_geometric_mean, success
from quasistatic_ref.lab.study.store.continued import solver_label

WANTED = 6.0
"""Digits for which times are given: those that a simulator's step should have."""
QUIET = 0.25
"""Load of each core when a study began, above which its times are not ranked."""
FEWEST = 5
"""Pairs of one solver from which the noise of its mean is given."""
MOST_OF = 90.0
"""The percentile of solvers that the floor of the noise is [%]."""


@dataclass(frozen=True)
class Noise:
    """How far two measurements of the same call differ.

    Parameters
    ----------
    pairs : int
        Measurements that were solved twice, at different moments.
    call : float or None
        Median of |t_1 / t_2 - 1| of one measurement [-].
    floor : float or None
        Of the shifted geometric mean of a solver's times, the 90th percentile of solvers [-]:
        smaller differences between solvers are ties. None where nothing was measured twice.
    """

    pairs: int
    call: float | None
    floor: float | None

    @property
    def words(self) -> str:
        """The noise as a sentence."""
        if self.floor is None or self.call is None:
            return (
                "No measurement was repeated, or too few were: the noise of these times is not "
                "known, and no difference is called a tie."
            )
        return (
            f"{self.pairs:,} measurements were repeated after all others. The two times of a "
            f"measurement differ by {100 * self.call:.0f} % (median), the two mean times of a "
            f"solver by at most {100 * self.floor:.0f} % for nine solvers of ten. Solvers that "
            "differ by less are tied."
        )


def noise_of(rows: Rows) -> Noise:
    """The noise of a study, from its rows of repetitions 0 and 1."""
    twice: dict[str, list[tuple[float, ...]]] = {}
    calls = rows.at(solved=True).groups("label", "problem", "setting", "units", "warm")
    for (label, *_), own in calls.items():
        times = {row["repetition"]: row["seconds"] for row in own}
        if len(times) == 2:
            twice.setdefault(label, []).append((times[0], times[1]))
    pairs = np.array([pair for own in twice.values() for pair in own])
    if not len(pairs):
        return Noise(0, None, None)
    means = [
        abs(np.log(shifted_geometric_mean(before) / shifted_geometric_mean(after)))
        for before, after in (np.transpose(own) for own in twice.values() if len(own) >= FEWEST)
    ]
    spread = np.exp(abs(np.diff(np.log(pairs)))) - 1
    floor = float(np.exp(np.percentile(means, MOST_OF)) - 1) if means else None
    return Noise(len(pairs), float(np.median(spread)), floor)


@dataclass(frozen=True, eq=False)
class Soonest:
    """One solver at its setting for 6 digits.

    Parameters
    ----------
    label, setting : str
    rows : Rows
        Its calls there, on the half that it is judged on.
    missing : int
        Calls, of all problems, that a budget did not reach.
    limit : float
        Of a call [s].
    """

    label: str
    setting: str
    rows: Rows
    missing: int
    limit: float

    @property
    def machine(self) -> str:
        """Where its calls were made, if several were merged."""
        return str(self.rows.first("machine"))

    @property
    def times(self) -> np.ndarray:
        """Of its calls, the time limit where the digits were not delivered, shape (calls,) [s]."""
        return to_digits(self.rows, self.limit)

    @property
    def mean(self) -> float:
        """Shifted geometric mean of the times [s]."""
        return shifted_geometric_mean(self.times)


def to_digits(rows: Rows, limit: float) -> np.ndarray:
    """Times to 6 digits, shape (rows,) [s]: the limit where they were not delivered."""
    return np.where(rows["digits"] < WANTED, limit, rows["seconds"])


@dataclass(frozen=True, eq=False)
class Comparison:
    """The rows of a study that a report compares first.

    Parameters
    ----------
    study : mapping
        As a store has it.
    every : Rows
        All of its rows.
    first : Rows
        Those of the first repetition.
    rows : Rows
        Those of them on problems that have a solution, if there are any.
    settings : list of str
        Each solver's own first, then from loose to tight.
    base : mapping
        The units, and warm or cold starts, with which most solvers were run.
    noise : Noise
    """

    study: Mapping[str, Any]
    every: Rows
    first: Rows
    rows: Rows
    settings: list[str]
    base: Where
    noise: Noise

    @cached_property
    def soonest(self) -> list[Soonest]:
        """Each solver and interface at its setting, the fastest first, or that with most digits."""
        chosen: dict[str, tuple[float, int, str]] = {}
        for (label, setting), rows in self.calls.groups("label", "setting").items():
            half = rows.at(half=0) or rows
            mean = shifted_geometric_mean(to_digits(half, self.limit))
            order = self.settings.index(setting)
            if label not in chosen or (mean, order) < chosen[label][:2]:
                chosen[label] = (mean, order, setting)
        found = [self._soonest(label, setting) for label, (*_, setting) in chosen.items()]
        return sorted(found, key=self._order)

    def _soonest(self, label: str, setting: str) -> Soonest:
        rows = self.rows.at(self.at(setting), label=label)
        rows = rows.at(half=1) or rows
        called = rows.at(called=True) or rows
        missing = len(self.first.at(self.at(setting), label=label, called=False))
        return Soonest(label, setting, called, missing, self.limit)

    def every_call(self, one: Soonest) -> Rows:
        """The calls at its setting, of all problems, with a solution and without."""
        return self.first.at(self.at(one.setting), label=one.label, called=True)

    def _order(self, one: Soonest) -> tuple[float, str]:
        six = success(one.rows["digits"], WANTED)
        return (-six if self.busy else one.mean), one.label

    @property
    def limit(self) -> float:
        """Of a call [s]."""
        return float(self.study["time_limit"])

    @property
    def busy(self) -> str:
        """Why times are not ranked, as a sentence; empty if they are."""
        machine = self.study["machine"]
        machines = [machine[name] for name in self.study.get("machines", [])] or [machine]
        for one in machines:
            load = str(one.get("load", "0")).split()[0]
            cores = one.get("cores") or 1
            if float(load) > QUIET * cores:
                return (
                    f"Times are not ranked: when the study began the load was {load} on {cores} "
                    f"cores, and above {QUIET:g} a core they measure other programs, too. Solvers "
                    f"stand in the order of their share with {WANTED:g} digits."
                )
        return ""

    @cached_property
    def calls(self) -> Rows:
        """The rows that are compared first, of calls that were made."""
        return self.rows.at(self.base, called=True)

    def fastest(self) -> list[Soonest]:
        """Of the interfaces to a solver that say most, the one with the soonest 6 digits."""

        def silent_and_slow(one: Soonest) -> tuple[bool, float]:
            return hides(one.rows.first("interface"), one.rows.first("solver")), one.mean

        found = [one for one in self.soonest if one.machine == self.figure_machine]
        by_solver: dict[str, Soonest] = {}
        for one in sorted(found, key=silent_and_slow):
            by_solver.setdefault(one.rows.first("who"), one)
        return sorted(by_solver.values(), key=self._order)

    @property
    def figure_machine(self) -> str:
        """The machine that figures are of; empty where there is only one."""
        counts = Counter(str(row["machine"]) for row in self.rows)
        return min(counts, key=lambda name: (-counts[name], name))

    @property
    def options(self) -> dict[str, Mapping[str, Any]]:
        """The options of each solver at each setting, by ``interface:name``."""
        return {solver_label(s): s["options"] for s in self.study["solvers"]}

    def at(self, setting: str) -> Where:
        """The fields of the rows that are compared first, at one setting."""
        return {**self.base, "setting": setting}

    @property
    def main(self) -> list[str]:
        """The settings, at most two, with the most calls."""
        counts = {s: len(self.rows.at(self.at(s))) for s in self.settings}
        two = sorted(self.settings, key=lambda s: -counts[s])[:2]
        return [s for s in self.settings if s in two and counts[s]]


def comparison_of(study: Mapping[str, Any], every: Rows) -> Comparison:
    """The comparison of a store.

    Parameters
    ----------
    study : mapping
    every : Rows
        All of its rows on problems that were solved alone.
    """
    first = every.at(repetition=0)
    rows = first.at(feasible=True) or first
    there = set(rows["setting"])
    settings = [s for s in study["settings"] if s["name"] in there]
    settings.sort(key=lambda s: -np.inf if s["accuracy"] is None else -s["accuracy"])
    parts = rows.groups("units", "warm")
    widest = max(parts, key=lambda key: (len(set(parts[key]["label"])), len(parts[key])))
    base: Where = dict(zip(("units", "warm"), widest, strict=True))
    names = [s["name"] for s in settings]
    return Comparison(study, every, first, rows, names, base, noise_of(every))
