"""Simulation parameters swept over scenarios: mu_omega, h, K_q, k, the cone, or any other field.

Every combination of the values is one run, each step exact; a row is what the run came to.
"""

import hashlib
import itertools
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError, RunFailed
from quasistatic_ref.formats.files import json_text, writable_folder
from quasistatic_ref.lab.parallel import results, workers
from quasistatic_ref.lab.study.measuring.environment import machine, versions
from quasistatic_ref.lab.study.store.rows import Row, key_of
from quasistatic_ref.lab.study.store.store import Store
from quasistatic_ref.optional.account.words import measures
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.tolerances import LARGE

RUNS = "runs"
"""Folder of trajectories in that of a store."""
DONE = "done"
ENDED_EARLY = "ended_early"
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
    """A scenario, and the values that it is run with.

    Parameters
    ----------
    name : str
        Of the sweep; no other has it.
    scenario : str
        A name, or a file.
    duration : float or None
        Of each run [s]; None: the scenario's steps, whatever h is.
    axes : tuple of Axis
    fixed : tuple of str
        Changes of the scenario that all runs have, ``dotted.key=value``.
    """

    name: str
    scenario: str
    duration: float | None
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
            If the duration makes too many steps.
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


def sweep_scenario(sweep: Sweep, point: Mapping[str, Any]) -> Scenario:
    """The scenario at one point of a sweep."""
    return load_scenario(sweep.scenario, sweep.settings(point))


def is_value(value: object) -> bool:
    """Whether an axis may have it: a word, or a finite number."""
    return isinstance(value, str) or (isinstance(value, int | float) and abs(value) < LARGE)


def run_sweep(
    sweeps: Sequence[Sweep],
    folder: str | Path,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run sweeps, or what is left of them. What cannot be run is refused before any is.

    The trajectory of each run is kept, in :func:`run_file` of the folder.

    Parameters
    ----------
    sweeps : sequence of Sweep
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

    Raises
    ------
    InputError
        If any of the scenarios is unusable, or the folder is or holds something else.
    """
    every = [(sweep, point) for sweep in sweeps for point in sweep.points()]
    with _workers(jobs, scheduler) as (executor, slots):
        for _ in executor.map(check_point, *zip(*every, strict=True)):
            pass  # an error of any of them is raised here
        folder = writable_folder(folder)
        writable_folder(folder / RUNS)
        with Store(folder, sweep_record(sweeps)) as store:
            done = store.keys
            todo = [(s, p) for s, p in every if key_of(_name_fields(s, p)) not in done]
            _run(store, todo, executor, slots, progress, folder)
            return sorted(store.rows, key=key_of)


@contextmanager
def _workers(jobs: int | None, scheduler: str | None) -> Iterator[tuple[Executor, int]]:
    """What runs several scenarios at once, and how many."""
    if scheduler is not None:
        from quasistatic_ref.lab.study.measuring.cluster import executor_of

        with executor_of(scheduler) as there:
            yield there
    else:
        with workers(jobs) as pool:
            yield pool, jobs or os.cpu_count() or 1


def check_point(sweep: Sweep, point: dict[str, Any]) -> None:
    """Refuse a point whose scenario cannot be run; InputError as :func:`.load_scenario` has it."""
    sweep_scenario(sweep, point).simulator()


def sweep_record(sweeps: Sequence[Sweep]) -> dict[str, Any]:
    """What a store says of sweeps."""
    return {
        "kind": "sweep",
        "sweeps": [asdict(sweep) for sweep in sweeps],
        "versions": versions(()),
        "machine": machine(),
    }


def run_file(row: Row) -> str:
    """Where the trajectory of a run is kept, in the folder of its store: named by its values."""
    return f"{RUNS}/{row['sweep']}_{hashlib.sha256(key_of(row)[1].encode()).hexdigest()[:12]}.npz"


def sweep_run(sweep: Sweep, point: dict[str, Any]) -> tuple[Row, Trajectory]:
    """One run, and what it came to; a run that ends early is a result too.

    Raises
    ------
    KeyboardInterrupt
        If the user ended it.
    """
    begin = time.perf_counter()
    scenario = sweep_scenario(sweep, point)
    outcome = DONE
    reason = None
    try:
        trajectory = scenario.run(progress=False)
    except RunFailed as failure:
        if isinstance(failure.__cause__, KeyboardInterrupt):
            raise KeyboardInterrupt from None
        outcome = ENDED_EARLY
        reason = failure.reason
        trajectory = failure.trajectory
    came_to = outcomes(trajectory)
    row = _name_fields(sweep, point) | {"outcome": outcome, "reason": reason, "measures": came_to}
    return row | {"seconds": {"call": time.perf_counter() - begin}}, trajectory


def _run(
    store: Store,
    todo: list[tuple[Sweep, dict[str, Any]]],
    executor: Executor,
    slots: int,
    progress: bool,
    folder: Path,
) -> None:
    """Run what is left, and add its rows to the store."""
    with progress_bar(total=len(todo), unit="run", shown=progress) as bar:
        for row, trajectory in results(executor, slots, sweep_run, todo):
            trajectory.save(folder / run_file(row))  # before the row, which names it
            store.add(row)
            bar.update()


def _name_fields(sweep: Sweep, point: dict[str, Any]) -> Row:
    return {"sweep": sweep.name, "scenario": Path(sweep.scenario).stem, "values": point}


def outcomes(trajectory: Trajectory) -> dict[str, float | None]:
    """Measured outcomes of one run.

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    dict
        What :func:`.words.measures` gives of its account, ``boundary_layer_um``,
        ``quasi_dynamic_number``, ``steps`` and ``exact`` (share of steps certified exactly).
    """
    Pi = trajectory.header["quasi_dynamic_number"]
    exact = trajectory["certificate"] == "exact" if trajectory.steps else np.ones(1)
    return {
        **measures(trajectory.account(forces=False)),
        "boundary_layer_um": 1e6 * float(trajectory.header["largest_boundary_layer"]),
        "quasi_dynamic_number": None if Pi is None else float(Pi),
        "steps": float(trajectory.steps),
        "exact": float(np.mean(exact)),
    }
