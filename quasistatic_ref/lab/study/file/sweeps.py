"""Studies of kind ``"sweep"``: which scenarios are run with which values, read field by field."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.study.file.fields import AXIS, SWEEP, SWEEPS, TABLES
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.tolerances import LARGE

MOST_RUNS = 100_000


@dataclass(frozen=True)
class Axis:
    """One parameter and its values.

    Parameters
    ----------
    name : str
        In the table.
    fields : tuple of str
        Dotted fields of the scenario that are set to each value, all of them.
    values : tuple
    """

    name: str
    fields: tuple[str, ...]
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Sweep:
    """One ``[[sweeps]]`` table, read.

    Parameters
    ----------
    name : str
        Of the sweep; no other has it.
    scenario : str
        A name, or a file.
    link : str
        Whose motion is measured.
    duration : float or None
        Of each run [s]; None: the scenario's steps, whatever h is.
    since : float
        From when on rotation and rise are measured [s].
    axes : tuple of Axis
    fixed : tuple of str
        Changes of the scenario that all runs have, ``dotted.key=value``.
    """

    name: str
    scenario: str
    link: str
    duration: float | None
    since: float
    axes: tuple[Axis, ...]
    fixed: tuple[str, ...] = ()

    def points(self) -> list[dict[str, Any]]:
        """Every combination of values, by the names of the axes."""
        names = [axis.name for axis in self.axes]
        return [
            dict(zip(names, values, strict=True))
            for values in itertools.product(*(axis.values for axis in self.axes))
        ]

    def settings(self, point: Mapping[str, Any]) -> list[str]:
        """One combination as changes of the scenario.

        Raises
        ------
        InputError
            If the study's duration makes too many steps.
        """
        changes = list(self.fixed)
        for axis in self.axes:
            changes += [f"{field}={json_text(point[axis.name])}" for field in axis.fields]
        if self.duration is not None:
            h = load_scenario(self.scenario, changes).h
            if not self.duration / h <= LARGE:
                problem = f"makes more than {LARGE:g} steps of {h:g} s"
                raise InputError(problem, field="duration", value=self.duration)
            changes.append(f"steps={round(self.duration / h)}")
        return [*changes, 'record="light"', "fast=true"]


def sweep_study(
    path: Path, tables: dict[str, Any], quick: bool = False, settings: Sequence[str] = ()
) -> tuple[Sweep, ...]:
    """The sweeps of a study file.

    Parameters
    ----------
    path : Path
    tables : dict
    quick : bool
        The first and the last value of each axis only.
    settings : sequence of str
        Changes of all scenarios, ``dotted.key=value``.

    Raises
    ------
    InputError
        Naming the file, the field and the value.
    """
    try:
        top = TableReader(tables)
        sweeps: dict[str, Sweep] = {}
        for i, table in enumerate(TABLES.all_values(top, SWEEPS)["sweeps"]):
            sweep = _sweep(TableReader(table, f"sweeps[{i}]"), path.parent, quick, settings)
            if sweep.name in sweeps:
                raise top.error_about(f"sweeps[{i}].name", "is given twice", sweep.name)
            sweeps[sweep.name] = sweep
    except InputError as error:
        raise error.in_file(path) from None
    return tuple(sweeps.values())


def _sweep(table: TableReader, folder: Path, quick: bool, settings: Sequence[str]) -> Sweep:
    given = TABLES.all_values(table, SWEEP)
    named = given["scenario"]
    link = given["link"]
    scenario = str(folder / named) if named.endswith(".toml") else named
    name = Path(named).stem if given["name"] is None else given["name"]
    axes = _axes(given["axes"], quick)
    duration = given["duration"]
    sweep = Sweep(name, scenario, link, duration, given["since"], axes, tuple(settings))
    count = len(sweep.points())
    if count > MOST_RUNS:
        raise table.error_about("axes", f"make more than {MOST_RUNS} runs", count)
    sweep_scenario(sweep, sweep.points()[0]).system.link(link)
    return sweep


def sweep_scenario(sweep: Sweep, point: Mapping[str, Any]) -> Scenario:
    """The scenario at one point of a sweep."""
    return load_scenario(sweep.scenario, sweep.settings(point))


def _axes(tables: TableReader, quick: bool) -> tuple[Axis, ...]:
    axes = []
    for name in tables.names_left():
        table = tables.table(name)
        given = TABLES.all_values(table, AXIS)
        values = given["values"]
        if not all(map(is_value, values)):
            raise table.error_about("values", "must be a list of finite numbers or words", values)
        chosen = dict.fromkeys([values[0], values[-1]] if quick else values)
        axes.append(Axis(name, tuple(given["fields"] or [name]), tuple(chosen)))
    if not axes:
        raise tables.error("must contain at least one table", field=tables.where)
    return tuple(axes)


def is_value(value: object) -> bool:
    """Whether an axis may have it: a word, or a finite number."""
    return isinstance(value, str) or (isinstance(value, int | float) and abs(value) < LARGE)
