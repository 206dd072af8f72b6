"""A study: what is measured, in which order, and how a study that was stopped goes on."""

import json
import random
import time
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby, product
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_read, json_text, text_written, writable_folder
from quasistatic_ref.lab.cluster import executor_of
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.parallel import results
from quasistatic_ref.lab.study.accepted import check_options
from quasistatic_ref.lab.study.doors import neighbour
from quasistatic_ref.lab.study.fields import COLD
from quasistatic_ref.lab.study.grade import grades, problem_forms, ungraded_fields
from quasistatic_ref.lab.study.problems.for_study import study_problems
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.row import NOT_RUN, TIMEOUT, Row, key_of
from quasistatic_ref.lab.study.solvers import CVXPY, FUNCTION, Setting, Solver
from quasistatic_ref.lab.study.store import ROWS, rows_read, rows_written
from quasistatic_ref.lab.study.study_file import Limits, Study
from quasistatic_ref.lab.study.worker import Answer, Ended, Question, SolverProcess
from quasistatic_ref.simulate.progress import progress_bar

RECORD = "study.json"
EVERY = 5.0
"""Seconds between two writings of the rows."""
BLOCK = 40
"""Measurements that travel to a cluster at once."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """A problem, a solver and how it is called.

    Parameters
    ----------
    problem : Problem
    solver : Solver
    setting : Setting
    units : str
    start : str
    before : Problem or None
        The step before it, whose answer it starts from.
    """

    problem: Problem
    solver: Solver
    setting: Setting
    units: str
    start: str
    before: Problem | None = None

    def row(self, limits: Limits, fields: dict[str, Any]) -> Row:
        """The row of it, with what was `fields`."""
        facts = self.problem.facts
        return Row(
            problem=self.problem.id,
            family=facts["family"],
            n=facts["n"],
            m=facts["m"],
            dial=None if facts["dial"] is None else float(facts["dial"]),
            solver=self.solver.name,
            door=self.solver.door,
            version=self.solver.version,
            setting=self.setting.name,
            options=self.options(limits),
            units=self.units,
            start=self.start,
            machine=processor(),
            **({"started": False} | fields),
        )

    def key(self, limits: Limits) -> tuple[str, ...]:
        """What tells it from others."""
        nothing = ungraded_fields(NOT_RUN, "", self.problem.feasible)
        return key_of(self.row(limits, nothing))

    def options(self, limits: Limits) -> str:
        """The options that its solver is given, as JSON."""
        return json_text(self.solver.settings_of(self.setting, limits.time_limit))


@cache
def processor() -> str:
    """The processor of this machine."""
    return str(machine()["processor"])


def plan(study: Study, problems: Sequence[Problem], warm: Container[str]) -> list[Measurement]:
    """What a study measures: a solver after the other; of each, problems in one random order.

    The steps of a sequence follow each other, as they do in the set.

    Parameters
    ----------
    study : Study
    problems : sequence of Problem
    warm : container of str
        Labels of the solvers that use a start.
    """
    groups: list[list[Problem]] = []
    for _, some in groupby(problems, lambda one: (one.facts["sequence"] or {}).get("name", one.id)):
        groups.append(list(some))
    random.Random(1).shuffle(groups)
    measurements: dict[tuple[object, ...], Measurement] = {}
    for part in study.parts:
        for solver, setting in product(part.solvers, part.settings):
            if not solver.takes(setting):
                continue
            for group, units, start in product(groups[:: part.every], part.units, part.starts):
                goes_on = start != COLD and len(group) > 1
                # What CVXPY has compiled takes a start with another g alone.
                starts = solver.label in warm and not (goes_on and solver.door == CVXPY)
                if start != COLD and not starts:
                    continue
                steps = [replace(one, units=group[0].units) for one in group] if goes_on else group
                for one, before in zip(steps, [None, *steps], strict=False):
                    key = one.id, solver.label, setting.name, units, start
                    last = before if goes_on else None
                    measurements[key] = Measurement(one, solver, setting, units, start, last)
    order = {solver.label: place for place, solver in enumerate(study.solvers)}
    return sorted(measurements.values(), key=lambda one: order[one.solver.label])


def run_study(
    study: Study,
    folder: str | Path,
    *,
    scheduler: str | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run a study, or what is left of it.

    Parameters
    ----------
    study : Study
    folder : str or Path
        Of its rows and problems; one that was begun with the same problems and limits goes on.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers call solvers at once; else one call at a time.
    progress : bool

    Returns
    -------
    list of Row
        All rows of the folder.

    Raises
    ------
    InputError
        If the folder holds another study, a solver cannot be reached, or it does not know an
        option or refuses its value: before anything is measured.
    KeyboardInterrupt
        After Ctrl-C; the rows until then are kept.
    """
    warm = warm_solvers(study)
    folder = writable_folder(folder)
    _check_record(folder / RECORD, study)
    problems = study_problems(study.problems, folder, progress)
    rows = rows_read(folder) if (folder / ROWS).exists() else []
    there = {key_of(row) for row in rows}
    todo = [one for one in plan(study, problems, warm) if one.key(study.limits) not in there]
    with progress_bar(total=len(todo), unit="row", shown=progress) as bar:
        written = time.monotonic()
        try:
            for some in _measured_all(study, todo, scheduler):
                rows += some
                bar.update(len(some))
                if time.monotonic() - written > EVERY:
                    rows_written(folder / ROWS, rows)
                    written = time.monotonic()
        finally:
            rows_written(folder / ROWS, rows)
    return rows


def warm_solvers(study: Study) -> set[str]:
    """The labels of solvers that use a start.

    Functions are imported in processes of their own, since that may start or end anything.

    Raises
    ------
    InputError
        If a solver would not get an option, or a function is not there.
    """
    for solver, setting in product(study.solvers, study.settings):
        if solver.door != FUNCTION and solver.takes(setting):
            options = solver.settings_of(setting, study.limits.time_limit)
            check_options(solver.door, solver.target, options)
    labels = set()
    for solver in study.solvers:
        if solver.door == FUNCTION:
            with SolverProcess(solver, study.folder, study.limits.memory) as process:
                warm = process.start()
        else:
            warm = solver.warm
        labels |= {solver.label} if warm else set()
    return labels


def _check_record(path: Path, study: Study) -> None:
    """Write what a study is about, or refuse a folder of another one."""
    wanted = json.loads(json_text({"limits": vars(study.limits), "problems": vars(study.problems)}))
    if path.exists():
        if {**json_read(path), "machine": 0} != wanted | {"machine": 0}:
            words = "holds another study, of other problems or limits; choose another folder"
            raise InputError(words, file=path.parent)
    else:
        text_written(path, json.dumps(wanted | {"machine": machine()}, indent=1) + "\n")


def _measured_all(
    study: Study, todo: Sequence[Measurement], scheduler: str | None
) -> Iterator[Sequence[Row]]:
    """The rows of all measurements, as they come: one after the other, or from a cluster."""
    by_solver = [
        list(measurements) for _, measurements in groupby(todo, key=lambda one: one.solver.label)
    ]
    if scheduler is None:
        for measurements in by_solver:
            for row in measured(measurements, study.limits, study.folder):
                yield [row]
        return
    tasks = []
    for measurements in by_solver:
        limits = replace(study.limits, budget=study.limits.budget * BLOCK / len(measurements))
        tasks += [
            (measurements[i : i + BLOCK], limits, study.folder)
            for i in range(0, len(measurements), BLOCK)
        ]
    with executor_of(scheduler) as (executor, slots):
        yield from results(executor, slots, rows_of_block, tasks)


def rows_of_block(measurements: Sequence[Measurement], limits: Limits, folder: str) -> list[Row]:
    """The rows of some measurements of one solver, on a worker of a cluster."""
    return list(measured(measurements, limits, folder))


def measured(measurements: Sequence[Measurement], limits: Limits, folder: str) -> Iterator[Row]:
    """The rows of measurements of one solver, in its process.

    Parameters
    ----------
    measurements : sequence of Measurement
    limits : Limits
    folder : str
        Where the file of a function is looked for.

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    spent = 0.0
    seen: set[object] = set()
    with SolverProcess(measurements[0].solver, folder, limits.memory) as process:
        for one in measurements:
            begin = time.perf_counter()
            if spent > limits.budget:
                fields = ungraded_fields(NOT_RUN, "budget", one.problem.feasible)
            else:
                if not process.is_there:
                    seen.clear()
                fields = _measured_fields(process, one, limits, seen)
            spent += time.perf_counter() - begin
            yield one.row(limits, fields)


def _measured_fields(
    process: SolverProcess, one: Measurement, limits: Limits, seen: set[object]
) -> dict[str, Any]:
    """What one measurement finds, as fields of its row."""
    ready = problem_forms(one.problem)
    form = ready.forms[one.units]
    options = one.solver.settings_of(one.setting, limits.time_limit)
    in_order = one.problem.facts["sequence"] is not None and one.start != COLD
    start = None if one.start == COLD or in_order else neighbour(form, one.problem.id)
    question = Question(form, options, 1, start, one.before is not None)
    shape = (*form.A.shape, one.setting.name, one.units, one.start)
    starts = 1 if start is None else 2
    try:
        if one.before is not None and process.kept != one.before.id:
            last = problem_forms(one.before).forms[one.units]
            process.keep(one.before.id, Question(last, options), limits.warm_up)
        if shape not in seen:  # a solver may compile at the first call of a shape
            process.ask(question, limits.warm_up)
            seen.add(shape)
        first = process.ask(question, starts * limits.time_limit)
        again = first
        if limits.repetitions > 1 and first.reply.solved:
            many = replace(question, calls=limits.repetitions - 1)
            again = process.ask(many, starts * limits.repetitions * limits.time_limit)
        if in_order:  # what the next step goes on from
            process.keep(one.problem.id, question, limits.time_limit)
    except Ended as end:
        fields = ungraded_fields(end.outcome, str(end), one.problem.feasible)
        return fields | {"seconds_first": limits.time_limit if end.outcome == TIMEOUT else None}
    return _graded(one, ready, first, again) | {"memory": process.peak or None}


def _graded(one: Measurement, ready: Any, first: Answer, again: Answer) -> dict[str, Any]:
    """The fields of a measurement that came back."""
    solver = one.solver
    promise = solver.promise(one.setting, solver.settings_of(one.setting, 1.0))
    fields = grades(ready, one.units, first.reply, solver, promise, one.setting.accuracy)
    times = first.times if again is first else (*first.times, *again.times)
    low, middle, high = np.percentile(times, [25, 50, 75]).tolist()
    return fields | {
        "started": first.started,
        "seconds": middle,
        "seconds_low": low,
        "seconds_high": high,
        "seconds_first": first.times[0],
        "calls": len(times),
    }
