"""Studies of kind ``"sweep"``: which scenarios are run with which values, read field by field."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import json_text
from quasistatic_ref.lab.study.spec import header
from quasistatic_ref.simulate.scenario import Scenario, load_scenario
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
    """

    name: str
    scenario: str
    link: str
    duration: float | None
    since: float
    axes: tuple[Axis, ...]

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
        changes = [
            f"{field}={json_text(point[axis.name])}" for axis in self.axes for field in axis.fields
        ]
        if self.duration is not None:
            h = load_scenario(self.scenario, changes).h
            if not self.duration / h <= LARGE:
                problem = f"makes more than {LARGE:g} steps of {h:g} s"
                raise InputError(problem, field="duration", value=self.duration)
            changes.append(f"steps={round(self.duration / h)}")
        return [*changes, 'record="light"']


def sweep_study(path: Path, tables: dict[str, Any], quick: bool = False) -> tuple[Sweep, ...]:
    """The sweeps of a study file.

    Parameters
    ----------
    path : Path
    tables : dict
    quick : bool
        The first and the last value of each axis only.

    Raises
    ------
    InputError
        Naming the file, the field and the value.
    """
    try:
        top = Fields(tables)
        header(top)
        sweeps: dict[str, Sweep] = {}
        for i, table in enumerate(top.sequence("sweeps")):
            sweep = _sweep(Fields(table, f"sweeps[{i}]"), path.parent, quick)
            if sweep.name in sweeps:
                raise top.fail(f"sweeps[{i}].name", "is given twice", sweep.name)
            sweeps[sweep.name] = sweep
        top.close()
        if not sweeps:
            raise top.fail("sweeps", "must hold at least one table")
    except InputError as error:
        raise error.in_file(path) from None
    return tuple(sweeps.values())


def _sweep(table: Fields, folder: Path, quick: bool) -> Sweep:
    named = table.text("scenario")
    scenario = str(folder / named) if named.endswith(".toml") else named
    name = table.text("name", Path(named).stem)
    link = table.text("link")
    duration = table.number("duration", None, above=0.0)
    since = table.number("since", 0.0, least=0.0)
    axes = _axes(table.table("axes"), quick)
    table.close()
    sweep = Sweep(name, scenario, link, duration, float(since), axes)
    count = len(sweep.points())
    if count > MOST_RUNS:
        raise table.fail("axes", f"make more than {MOST_RUNS} runs", count)
    sweep_scenario(sweep, sweep.points()[0]).system.link(link)
    return sweep


def sweep_scenario(sweep: Sweep, point: Mapping[str, Any]) -> Scenario:
    """The scenario at one point of a sweep."""
    return load_scenario(sweep.scenario, sweep.settings(point))


def _axes(tables: Fields, quick: bool) -> tuple[Axis, ...]:
    axes = []
    for name in tables.names():
        table = tables.table(name)
        fields = table.sequence("fields", [name])
        if not fields or not all(isinstance(f, str) and f for f in fields):
            raise table.fail("fields", "must be a list of dotted fields of the scenario", fields)
        values = table.sequence("values")
        if not values or not all(isinstance(v, str) or _is_finite(v) for v in values):
            raise table.fail("values", "must be a list of finite numbers or words", values)
        table.close()
        chosen = dict.fromkeys([values[0], values[-1]] if quick else values)
        axes.append(Axis(name, tuple(fields), tuple(chosen)))
    if not axes:
        raise tables.error("must hold at least one table", field="axes")
    return tuple(axes)


def _is_finite(value: Any) -> bool:
    return isinstance(value, int | float) and -LARGE < value < LARGE
