"""Simulation parameters swept over scenarios: mu_omega, h, K_q, k, the cone, or any other field.

Every combination of the values is one run, each step exact; a row is what the run came to.
"""

import hashlib
import os
import time
from collections.abc import Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import QuasistaticError, RunFailed
from quasistatic_ref.formats.files import writable_folder
from quasistatic_ref.lab.parallel import results
from quasistatic_ref.lab.study.file.sweeps import Sweep, sweep_scenario
from quasistatic_ref.lab.study.measuring.environment import machine, versions
from quasistatic_ref.lab.study.store.rows import Row, key_of
from quasistatic_ref.lab.study.store.store import Store
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.measures import link_motion
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.trajectory import Trajectory

RUNS = "runs"
"""Folder of trajectories in that of a store."""
DONE, ENDED_EARLY, REFUSED = "done", "ended_early", "refused"


def run_sweep(
    sweeps: Sequence[Sweep],
    folder: str | Path,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: bool = True,
    keep_runs: bool = False,
) -> list[Row]:
    """Run sweeps, or what is left of them.

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
    keep_runs : bool
        Whether the trajectory of each run is kept, in :func:`run_file` of the folder.

    Returns
    -------
    list of dict
        All rows of the store, sorted.
    """
    folder = writable_folder(folder)
    kept = writable_folder(folder / RUNS).parent if keep_runs else None
    with Store(folder, sweep_record(sweeps)) as store:
        done = store.keys
        every = [(sweep, point) for sweep in sweeps for point in sweep.points()]
        todo = [(s, p) for s, p in every if key_of(_naming(s, p)) not in done]
        if scheduler is not None:
            from quasistatic_ref.lab.study.measuring.cluster import executor_of

            with executor_of(scheduler) as (executor, slots):
                _run(store, todo, executor, slots, progress, kept)
        else:
            jobs = jobs or os.cpu_count() or 1
            with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
                _run(store, todo, pool, jobs, progress, kept)
        return sorted(store.rows, key=key_of)


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


def sweep_row(sweep: Sweep, point: dict[str, Any]) -> Row:
    """One run, and what it came to; a run that ends early is a result too."""
    return sweep_run(sweep, point)[0]


def sweep_run(sweep: Sweep, point: dict[str, Any]) -> tuple[Row, Trajectory | None]:
    """The same with its trajectory; a scenario that is refused has none."""
    begin = time.perf_counter()
    outcome, reason, measures = DONE, None, {}
    trajectory: Trajectory | None = None
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
    return row | {"seconds": {"call": time.perf_counter() - begin}}, trajectory


def _run(
    store: Store,
    todo: list[tuple[Sweep, dict[str, Any]]],
    executor: Executor,
    slots: int,
    progress: bool,
    kept: Path | None,
) -> None:
    """Run what is left, and add its rows to the store."""
    with progress_bar(total=len(todo), unit="run", shown=progress) as bar:
        if kept is None:
            for row in results(executor, slots, sweep_row, todo):
                store.add(row)
                bar.update()
            return
        for row, trajectory in results(executor, slots, sweep_run, todo):
            if trajectory is not None:  # before the row, which says that it is there
                trajectory.save(kept / run_file(row))
            store.add(row)
            bar.update()


def _naming(sweep: Sweep, point: dict[str, Any]) -> Row:
    return {"sweep": sweep.name, "scenario": Path(sweep.scenario).stem, "values": point}


def outcomes(
    scenario: Scenario, trajectory: Trajectory, link: str, since: float
) -> dict[str, float | None]:
    """Measured outcomes of one run.

    Parameters
    ----------
    scenario : Scenario
    trajectory : Trajectory
    link : str
        Whose motion is measured.
    since : float
        From when on [s].

    Returns
    -------
    dict
        ``rotation_deg`` (largest since then), ``rise_mm`` and ``travel_mm`` (from then to the
        end), ``deepest_um`` (largest penetration of any step), ``boundary_layer_um``,
        ``quasi_dynamic_number``, ``steps`` and ``exact`` (share of steps certified exactly).
    """
    motion = link_motion(scenario.system, trajectory, link)
    start = motion.index(since)
    way = motion.t[-1] - motion.t[start]
    phi = trajectory["phi"] if trajectory.steps else np.zeros(0)
    Pi = trajectory.header["quasi_dynamic_number"]
    exact = trajectory["certificate"] == "exact" if trajectory.steps else np.ones(1)
    return {
        "rotation_deg": float(np.degrees(motion.rotation_since(since)[start:].max())),
        "rise_mm": 1e3 * float(way[2]),
        "travel_mm": 1e3 * float(np.linalg.norm(way)),
        "deepest_um": 1e6 * max(0.0, float(-phi.min(initial=0.0))),
        "boundary_layer_um": 1e6 * float(trajectory.header["largest_boundary_layer"]),
        "quasi_dynamic_number": None if Pi is None else float(Pi),
        "steps": float(trajectory.steps),
        "exact": float(np.mean(exact)),
    }
