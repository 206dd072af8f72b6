"""A study of solvers, from its file to its store."""

import os
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from quasistatic_ref.formats.files import writable_folder
from quasistatic_ref.lab.study.file.study_file import Study
from quasistatic_ref.lab.study.measuring.environment import machine, versions
from quasistatic_ref.lab.study.measuring.measure import Limits
from quasistatic_ref.lab.study.measuring.plan import plan
from quasistatic_ref.lab.study.measuring.schedule import Work, conduct_here
from quasistatic_ref.lab.study.problems.qp import Problem
from quasistatic_ref.lab.study.problems.study_problems import problem_set, set_record
from quasistatic_ref.lab.study.store.store import (
    VERSION,
    Row,
    Store,
    key_of,
    label_of,
)
from quasistatic_ref.lab.study.store.unreached import unreached_written


def run_study(
    study: Study,
    folder: str | Path,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run a study, or what is left of it.

    Parameters
    ----------
    study : Study
    folder : str or Path
        The store; one that was begun with the same study is continued.
    jobs : int, optional
        Solvers called at once; by default as many as there are cores.
    scheduler : str, optional
        Address of a Dask scheduler, in place of this machine's cores.
    progress : bool

    Returns
    -------
    list of dict
        All rows of the store.

    Raises
    ------
    InputError
        If the folder holds another study, or a solver cannot be reached.
    """
    folder = writable_folder(folder)
    problems = problem_set(study.problems, folder, progress)
    planned = plan(study, [(p.id, p.facts.family) for p in problems])
    by_id = {p.id: p for p in problems}
    place = str(study.path.resolve().parent)
    with Store(folder, study_record(study, problems)) as store:
        done = store.keys
        todo = [m for m in planned if key_of(m.fields()) not in done]
        limits = Limits(study.time_limit, study.warm_up, study.repetitions)
        work = Work(store, todo, by_id, place, limits, study.budget, study.memory, progress)
        if scheduler is None:
            conduct_here(work, jobs or os.cpu_count() or 1)
        else:
            from quasistatic_ref.lab.study.measuring.cluster import conduct_on_cluster

            conduct_on_cluster(work, scheduler)
        unreached_written(folder, work.unreached)
        labels = {solver.label for solver in study.solvers}
        return [row for row in store.rows if label_of(row) in labels]


def study_record(study: Study, problems: Sequence[Problem]) -> dict[str, Any]:
    """What ``study.json`` holds: the study as it was resolved, machine and versions."""
    parts = [
        asdict(part)
        | {"solvers": [s.label for s in part.solvers], "settings": [s.name for s in part.settings]}
        for part in study.parts
    ]
    solvers = [
        {
            "name": s.name,
            "interface": s.interface,
            "target": s.target,
            "options": {
                t.name: s.settings_of(t, study.time_limit)
                for t in study.settings
                if s.takes(t)
            },
        }
        for s in study.solvers
    ]  # fmt: skip
    return {
        "format": "quasistatic-ref/study-store",
        "version": VERSION,
        "kind": "solvers",
        "time_limit": study.time_limit,
        "budget": study.budget,
        "warm_up": study.warm_up,
        "memory": study.memory,
        "repetitions": study.repetitions,
        "runs": parts,
        "settings": [asdict(s) for s in study.settings],
        "solvers": solvers,
        "problems": set_record(problems),
        "versions": versions(study.solvers),
        "machine": machine(),
    }
