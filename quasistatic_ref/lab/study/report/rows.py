"""The rows of solvers, chosen and grouped by what they say about themselves."""

import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.store.rows import NOT_RUN, SOLVED, Row, label_of

Where = Mapping[str, str | bool | int]
"""Field -> value: a filter, as the line below each table states it."""
EVERY: Where = MappingProxyType({})
FLAGS = ("warm", "feasible", "said_optimal", "said_infeasible", "wrong", "wrong_multipliers",
                "solved", "called")  # fmt: skip


MADE = 0.9
"""Share of the calls of the solver with the most that others need to be compared on the same."""


class Rows:
    """Rows of solvers, each with the fields that :func:`rows_of` adds.

    Parameters
    ----------
    rows : sequence of dict
    """

    def __init__(self, rows: Sequence[Row]) -> None:
        self._rows = rows

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self._rows)

    def __getitem__(self, name: str) -> np.ndarray:
        """One field, shape (rows,); NaN where a number is not known."""
        kind = bool if name in FLAGS else None
        return np.array([row[name] for row in self._rows], dtype=kind)

    def first(self, name: str) -> Any:
        """A field that all of the rows have alike."""
        return self._rows[0][name]

    def kept(self, keep: Callable[[Row], bool]) -> "Rows":
        """The rows of which something holds."""
        return Rows([row for row in self._rows if keep(row)])

    def at(self, where: Where = EVERY, **more: str | bool | int) -> "Rows":
        """The rows whose fields have these values."""
        rows = self._rows
        for name, value in {**where, **more}.items():
            rows = [row for row in rows if row[name] == value]
        return Rows(rows)

    def groups(self, *by: str) -> dict[tuple[Any, ...], "Rows"]:
        """The rows in parts, by the values of some fields, in the order in which these occur."""
        found: dict[tuple[Any, ...], list[Row]] = {}
        keys = zip(*([row[name] for row in self._rows] for name in by), strict=True)
        for key, row in zip(keys, self._rows, strict=True):
            found.setdefault(key, []).append(row)
        return {key: Rows(own) for key, own in found.items()}

    def common(self, *by: str) -> "Rows":
        """The rows on the problems on which every solver was called.

        Parameters
        ----------
        by : str
            The fields that distinguish one solver from another; ``"label"`` by default. Of these
            one that a budget kept from more than one problem of ten is left out.
        """
        by = by or ("label",)
        made = self.at(called=True).groups(*by).values()
        units = [{row["unit"] for row in part} for part in made]
        most = max(map(len, units), default=0) if "label" in by else 0
        kept = [(p, own) for p, own in zip(made, units, strict=True) if len(own) >= MADE * most]
        shared = set.intersection(*(own for _, own in kept)) if kept else set()
        return Rows([row for part, _ in kept for row in part if row["unit"] in shared])

    def sorted_by_unit(self, name: str) -> np.ndarray:
        """One field in the order of the problems, shape (rows,), so that rows compare."""
        return self[name][np.argsort(self["unit"])]


def rows_of(rows: Sequence[Row], limit: float) -> Rows:
    """Rows of a store, with the two conventions that every number of a report keeps.

    Parameters
    ----------
    rows : sequence of dict
    limit : float
        The study's time limit of a problem [s].

    Returns
    -------
    Rows
        With ``way`` (interface:solver), ``who`` (solver, and behind an @ the machine, where several
        were merged), ``label`` (interface:who); ``unit``, the problem with its repetition;
        ``called``, whether the call was made; ``half``, of the problems, and ``first``, the time
        of the first call [s]; ``digits``: those of delta_q that were delivered,
        0 where the solver does not say that it solved the problem; ``net`` likewise; ``seconds``:
        of the first call on a copy of the problem, in sequences of the repeated call; the time
        limit where the solver does not say so; ``call``: of any call.
    """
    return Rows([row | _derived_fields(row, limit) for row in rows])


def _derived_fields(row: Row, limit: float) -> Row:
    machine = row.get("machine", "")
    seconds = row["seconds"]
    solved = row["outcome"] == SOLVED
    ranked = "call" if row["mode"] else "first"
    who = f"{row['solver']}@{machine}" if machine else row["solver"]
    return {
        "machine": machine,
        "who": who,
        "way": label_of(row),
        "label": f"{row['interface']}:{who}",
        "unit": f"{row['problem']}#{row['repetition']}",
        "solved": solved,
        "called": row["outcome"] != NOT_RUN,
        "half": half_of(row["problem"]),
        "first": _or(seconds["first"]),
        "digits": _or(row["digits"]["delta_q"] if solved else None, 0.0),
        "net": _or(row["digits"]["net_wrench"] if solved else None, 0.0),
        "seconds": _or(seconds[ranked] if solved else None, limit),
        "call": _or(seconds["call"]),
        "iterations": _or(row["iterations"]),
    }


def half_of(problem: str) -> int:
    """The half of the problems that one is in, 0 or 1; all steps of a run are in the same."""
    return zlib.crc32(problem.rpartition("/")[0].encode()) % 2


def _or(value: float | None, otherwise: float = np.nan) -> float:
    return otherwise if value is None else value
