"""Simulation parameters swept over scenarios: mu_omega, h, K_q, k, the cone, or any other field.

Every combination of the values is one run, each step exact; a row is what the run came to.
"""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from tqdm import tqdm

from quasistatic_ref.errors import InputError, QuasistaticError, RunFailed
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import json_text, writable_folder
from quasistatic_ref.resources import scenario_path
from quasistatic_ref.simulate.scenario import Scenario, load_scenario
from quasistatic_ref.study.environment import machine, versions
from quasistatic_ref.study.outcomes import outcomes
from quasistatic_ref.study.spec import header
from quasistatic_ref.study.store import Row, Store, key_of

MOST_RUNS = 100_000
DONE, ENDED_EARLY, REFUSED = "done", "ended_early", "refused"


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
    """A study of kind ``"sweep"``, read.

    Parameters
    ----------
    path : Path
    scenario : str
    link : str
        Whose motion is measured.
    duration : float or None
        Of each run [s]; None: the scenario's steps, whatever h is.
    since : float
        From when on rotation and rise are measured [s].
    axes : tuple of Axis
    """

    path: Path
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
        """One combination as changes of the scenario."""
        changes = [
            f"{field}={_toml(point[axis.name])}" for axis in self.axes for field in axis.fields
        ]
        if self.duration is not None:
            h = load_scenario(self.scenario, changes).h
            changes.append(f"steps={round(self.duration / h)}")
        return [*changes, 'record="light"']


def sweep_study(path: Path, tables: dict[str, Any], quick: bool = False) -> Sweep:
    """A sweep from its tables.

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
        name = top.text("scenario")
        beside = path.parent / name
        scenario = str(beside) if beside.suffix == ".toml" else name
        link = top.text("link")
        duration = top.number("duration", None, above=0.0)
        since = top.number("since", 0.0, least=0.0)
        axes = _axes(top.table("axes"), quick)
        top.close()
        sweep = Sweep(path, scenario, link, duration, float(since), axes)
        count = len(sweep.points())
        if count > MOST_RUNS:
            raise top.fail("axes", f"make more than {MOST_RUNS} runs", count)
        scenario_path(scenario)
        sweep_scenario(sweep, sweep.points()[0]).system.link(link)
    except InputError as error:
        raise error.in_file(path) from None
    return sweep


def sweep_scenario(sweep: Sweep, point: Mapping[str, Any]) -> Scenario:
    """The scenario at one point of a sweep."""
    return load_scenario(sweep.scenario, sweep.settings(point))


def run_sweep(
    sweep: Sweep,
    folder: str | Path,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run a sweep, or what is left of it.

    Parameters
    ----------
    sweep : Sweep
    folder : str or Path
        The store.
    jobs : int, optional
        Runs at once.
    scheduler : str, optional
        Address of a Dask scheduler.
    progress : bool

    Returns
    -------
    list of dict
        All rows of the store, sorted.
    """
    folder = writable_folder(folder)
    with Store(folder, sweep_record(sweep)) as store:
        done = store.keys
        todo = [p for p in sweep.points() if key_of(_naming(sweep, p)) not in done]
        if scheduler is not None:
            from quasistatic_ref.study.cluster import executor_of

            with executor_of(scheduler) as (executor, slots):
                _conduct(store, sweep, todo, executor, slots, progress)
        else:
            jobs = jobs or os.cpu_count() or 1
            with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
                _conduct(store, sweep, todo, pool, jobs, progress)
        return sorted(store.rows, key=key_of)


def sweep_record(sweep: Sweep) -> dict[str, Any]:
    """What ``study.json`` of a sweep holds."""
    return {
        "format": "quasistatic-ref/study-store",
        "version": 1,
        "kind": "sweep",
        "scenario": sweep.scenario,
        "link": sweep.link,
        "duration": sweep.duration,
        "since": sweep.since,
        "axes": [
            {"name": a.name, "fields": list(a.fields), "values": list(a.values)} for a in sweep.axes
        ],
        "versions": versions(()),
        "machine": machine(),
    }


def sweep_row(sweep: Sweep, point: dict[str, Any]) -> Row:
    """One run, and what it came to; a run that ends early is a result too."""
    begin = time.perf_counter()
    outcome, reason, measures = DONE, None, {}
    try:
        scenario = sweep_scenario(sweep, point)
        try:
            trajectory = scenario.run(progress=False)
        except RunFailed as failure:
            outcome, reason, trajectory = ENDED_EARLY, failure.reason, failure.trajectory
        measures = outcomes(scenario, trajectory, sweep.link, sweep.since)
    except QuasistaticError as error:
        outcome, reason = REFUSED, str(error)
    row = _naming(sweep, point) | {"outcome": outcome, "reason": reason, "measures": measures}
    return row | {"seconds": {"call": time.perf_counter() - begin}}


def _conduct(
    store: Store,
    sweep: Sweep,
    todo: list[dict[str, Any]],
    executor: Executor,
    slots: int,
    progress: bool,
) -> None:
    left = list(reversed(todo))
    under_way: set[Future[Row]] = set()
    with tqdm(total=len(todo), unit="run", leave=False, disable=None if progress else True) as bar:
        while left or under_way:
            while left and len(under_way) < slots:
                under_way.add(executor.submit(sweep_row, sweep, left.pop()))
            done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            for future in done:
                store.add(future.result())
                bar.update()


def _naming(sweep: Sweep, point: dict[str, Any]) -> Row:
    return {"scenario": Path(sweep.scenario).stem, "values": point, "repetition": 0}


def _axes(tables: Fields, quick: bool) -> tuple[Axis, ...]:
    axes = []
    for name in tables.names():
        table = tables.table(name)
        fields = table.sequence("fields", [name])
        if not fields or not all(isinstance(f, str) and f for f in fields):
            raise table.fail("fields", "must be a list of dotted fields of the scenario", fields)
        values = table.sequence("values")
        if not values or not all(isinstance(v, int | float | str) for v in values):
            raise table.fail("values", "must be a list of numbers or words", values)
        table.close()
        chosen = dict.fromkeys([values[0], values[-1]] if quick else values)
        axes.append(Axis(name, tuple(fields), tuple(chosen)))
    if not axes:
        raise tables.error("must hold at least one table", field="axes")
    return tuple(axes)


def _toml(value: Any) -> str:
    return json_text(value)
