"""The rows of a study of solvers that a report compares first."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.report.columns import Columns, Where, chosen, groups, size
from quasistatic_ref.lab.study.report.headline import WANTED, Soonest, soonest
from quasistatic_ref.lab.study.report.noise import Noise, noise_of


@dataclass(frozen=True, eq=False)
class Comparison:
    """The rows of a study that a report compares first.

    Parameters
    ----------
    study : mapping
        As a store has it.
    first : mapping of str to ndarray
        Of the first repetition.
    columns : mapping of str to ndarray
        Those of them on problems that have a solution, if there are any.
    settings : list of str
        Each solver's own first, then from loose to tight.
    base : mapping
        The units, and warm or cold starts, with which most solvers were run.
    noise : Noise
    """

    study: Mapping[str, Any]
    first: Columns
    columns: Columns
    settings: list[str]
    base: Where
    noise: Noise

    def soonest(self, least: float) -> list[Soonest]:
        """Each solver at the setting that delivers so many digits soonest.

        Parameters
        ----------
        least : float
            Digits [-].
        """
        return soonest(self.columns, self.settings, self.base, least, self.study["time_limit"])

    def fastest(self) -> list[Soonest]:
        """Of the interfaces to one solver the one with the fastest 6 digits, for figures.

        Of merged results figures show one machine, that with most rows.
        """
        found = [one for one in self.soonest(WANTED[0]) if one.machine == self.drawn]
        by_solver = {str(one.rows["who"][0]): one for one in reversed(found)}
        return sorted(by_solver.values(), key=lambda one: one.mean)

    def best(self) -> list[str]:
        """The labels of these solvers."""
        return [one.label for one in self.fastest()]

    @property
    def drawn(self) -> str:
        """The machine that figures are of; empty where there is only one."""
        names, counts = np.unique(self.columns["machine"], return_counts=True)
        return str(names[counts.argmax()])

    def at(self, setting: str) -> Where:
        """The fields of the rows that are compared first, at one setting."""
        return {**self.base, "setting": setting}

    @property
    def main(self) -> list[str]:
        """The settings, at most two, with the most calls."""
        counts = {s: size(chosen(self.columns, self.at(s))) for s in self.settings}
        two = sorted(self.settings, key=lambda s: -counts[s])[:2]
        return [s for s in self.settings if s in two and counts[s]]


def comparison_of(study: Mapping[str, Any], every: Columns) -> Comparison:
    """The comparison of a store.

    Parameters
    ----------
    study : mapping
        As a store has it.
    every : mapping of str to ndarray
        All rows; what is compared is of the first repetition, on problems that have a solution if
        there are any.
    """
    first = chosen(every, {"repetition": 0})
    columns = chosen(first, {"feasible": True})
    columns = columns if size(columns) else first
    settings, base = _settings(study, columns), _widest(columns)
    return Comparison(study, first, columns, settings, base, noise_of(every))


def _settings(study: Mapping[str, Any], columns: Columns) -> list[str]:
    """The settings in the rows, each solver's own first, then from loose to tight."""
    found = [s for s in study["settings"] if s["name"] in set(columns["setting"])]
    found.sort(key=lambda s: -np.inf if s["accuracy"] is None else -s["accuracy"])
    return [s["name"] for s in found]


def _widest(columns: Columns) -> Where:
    """The units, and warm or cold starts, with which most solvers were run."""
    every = groups(columns, ["units", "warm"])
    (units, warm), _ = max(every, key=lambda one: (len(set(one[1]["label"])), size(one[1])))
    return {"units": units, "warm": warm == "True"}
