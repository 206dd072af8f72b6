"""A study of solvers, from its file to its store."""

import os
from collections.abc import Sequence
from dataclasses import asdict
from itertools import product
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import writable_folder
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.study.calling.accepted import OF_THE_INTERFACE, check_options
from quasistatic_ref.lab.study.file.study_file import Study
from quasistatic_ref.lab.study.measuring.environment import versions
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.plan import Measurement, plan
from quasistatic_ref.lab.study.measuring.schedule import Work, measure_here
from quasistatic_ref.lab.study.problems.for_study import fact_of, problems_record, study_problems
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.store.rows import Row, label_of
from quasistatic_ref.lab.study.store.store import Store


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
    for solver, setting in product(study.solvers, study.settings):
        if solver.takes(setting) and solver.interface in OF_THE_INTERFACE:
            options = solver.settings_of(setting, study.limits.time_limit)
            check_options(solver.interface, str(solver.target), options)
    folder = writable_folder(folder)
    problems = study_problems(study.problems, folder, progress)
    by_id = {one.id: one for one in problems}
    place = str(study.path.resolve().parent)
    unreached: dict[str, str] = {}
    planned = _plan_of_study(study, problems, place, unreached)
    facts = [fact_of(one) for one in problems]
    with Store(folder, study_record(study, problems), facts) as store:
        done = store.keys
        todo = [m for m in planned if m.key not in done]
        work = Work(store, todo, by_id, place, study.limits, progress, unreached)
        if scheduler is None:
            measure_here(work, jobs or os.cpu_count() or 1)
        else:
            from quasistatic_ref.lab.study.measuring.cluster import measure_on_cluster

            measure_on_cluster(work, scheduler)
        store.keep_unreached(work.unreached)
        labels = {solver.label for solver in study.solvers}
        return [row for row in store.rows if label_of(row) in labels]


def _plan_of_study(
    study: Study, problems: Sequence[Problem], folder: str, unreached: dict[str, str]
) -> list[Measurement]:
    """The plan of a study; solvers that cannot say in which modes they are called are unreached."""
    sequences: dict[str, list[Problem]] = {}
    for one in problems:
        if own := one.facts["sequence"]:
            sequences.setdefault(own["name"], []).append(one)
    modes = {}
    for solver in {s.label: s for part in study.parts if part.modes for s in part.solvers}.values():
        with Keeper(solver, folder) as keeper:
            try:
                keeper.start()
            except InputError as error:
                unreached[solver.label] = error.problem
            else:
                modes[solver.label] = keeper.modes
    steps = {
        name: [_names(one) for one in sorted(own, key=lambda one: one.facts["sequence"]["place"])]
        for name, own in sequences.items()
    }
    return plan(study, [_names(one) for one in problems], steps, modes)


def _names(problem: Problem) -> tuple[str, str]:
    return problem.id, str(problem.facts["family"])


def study_record(study: Study, problems: Sequence[Problem]) -> dict[str, Any]:
    """What a store says of its study: the study as it was resolved, machine and versions."""
    parts = [
        asdict(part)
        | {"solvers": [s.label for s in part.solvers], "settings": [s.name for s in part.settings]}
        for part in study.parts
    ]
    solvers = []
    for s in study.solvers:
        own = {t.name: t for t in study.settings if s.takes(t)}
        options = {name: s.settings_of(t, study.limits.time_limit) for name, t in own.items()}
        promise = {name: s.promises(t) for name, t in own.items()}
        solvers.append({"name": s.name, "interface": s.interface, "target": s.target,
                        "options": options, "promise": promise})  # fmt: skip
    return {
        "kind": "solvers",
        **asdict(study.limits),
        "runs": parts,
        "settings": [asdict(s) for s in study.settings],
        "solvers": solvers,
        "problems": problems_record(problems),
        "versions": versions(study.solvers),
        "machine": machine(),
    }
