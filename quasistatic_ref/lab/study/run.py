"""A study: what is measured, in which order, and how a study that was stopped goes on."""

import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from functools import cache
from itertools import groupby, product
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_read, json_text, text_written
from quasistatic_ref.lab.fingerprint import fingerprint
from quasistatic_ref.lab.folders import CONTACT_QP
from quasistatic_ref.lab.lock import locked
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.parallel import results
from quasistatic_ref.lab.study.accepted import check_options
from quasistatic_ref.lab.study.doors import neighbour
from quasistatic_ref.lab.study.grade import grades, problem_forms, ungraded_fields
from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.problems.names import NATURAL, UNITS
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.lab.study.problems.selection import groups_in_random_order, problems_taken
from quasistatic_ref.lab.study.row import COLD, NOT_RUN, STARTS, TIMEOUT, Row, key_of
from quasistatic_ref.lab.study.solvers import (
    CVXPY,
    FUNCTION,
    Setting,
    Solver,
    settings_of,
    solvers_of,
)
from quasistatic_ref.lab.study.store import ROWS, rows_read, rows_written
from quasistatic_ref.lab.study.worker import Answer, Ended, Question, SolverProcess
from quasistatic_ref.simulate.progress import progress_bar

RECORD = "study.json"
EVERY = 5.0
"""Seconds between two writings of the rows."""
BLOCK = 40
"""Measurements that are one call of an executor."""


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


def study(
    problems: Mapping[str, int] | Sequence[Problem],
    solvers: Sequence[str | Callable[..., Any] | Solver],
    settings: Sequence[str | Setting] = ("default",),
    folder: str | Path = "study",
    executor: Executor | None = None,
    *,
    units: Sequence[str] = (NATURAL,),
    starts: Sequence[str] = (COLD,),
    limits: Limits | None = None,
    progress: bool = True,
) -> list[Row]:
    """Put problems to solvers, or what is left of them: a row for each measurement.

    Parameters
    ----------
    problems : mapping of str to int, or sequence of Problem
        How many of each family of contact-qp; or problems, such as :func:`.problems_taken` and
        :func:`.problems_of_runs` return.
    solvers : sequence of str, callable or Solver
        ``"qpsolvers:NAME"``, ``"cvxpy:NAME"``, ``*`` for every NAME that is installed; functions
        ``(P, q, G, h) -> (x, z, status)``; what :func:`.function_solver` returns.
    settings : sequence of str or Setting
        Of ``"default"``, ``"low"``, ``"mid"``, ``"high"``, ``"tuned"``; or others.
    folder : str or Path
        Of the rows. A measurement whose row is there is not made again.
    executor : Executor, optional
        Any of ``concurrent.futures``, which measures at several places at once; by default one call
        after the other, so that none disturbs the times of another. Wherever it is, each solver has
        a process of its own with limits of time and memory.
    units : sequence of str
        Of ``"raw"`` and ``"natural"``.
    starts : sequence of str
        Of ``"cold"`` and ``"warm"``: from the solver's answer to the step before in a sequence,
        else to a neighbour.
    limits : Limits, optional
    progress : bool

    Returns
    -------
    list of Row
        All rows of the folder.

    Raises
    ------
    InputError
        If an argument is unusable, the folder holds another study or is being written, or a solver
        does not know an option or refuses its value: before anything is measured.
    KeyboardInterrupt
        After Ctrl-C; the rows until then are kept.
    """
    limits = limits or Limits()
    if isinstance(problems, Mapping):
        problems = problems_taken(CONTACT_QP, problems)
    chosen = solvers_of(solvers)
    at = settings_of(settings)
    _check(problems, chosen, at, limits)
    for field, values, known in (("units", units, UNITS), ("starts", starts, STARTS)):
        for value in values:
            if value not in known:
                raise InputError(f"must be of {', '.join(known)}", field=field, value=value)
    wanted = plan(problems, chosen, at, units, starts)
    folder = Path(folder)
    with locked(folder):
        _recorded(folder / RECORD, problems, limits)
        rows = rows_read(folder) if (folder / ROWS).exists() else []
        there = {key_of(row) for row in rows}
        todo = [one for one in wanted if one.key(limits) not in there]
        with progress_bar(total=len(todo), unit="row", shown=progress) as bar:
            written = time.monotonic()
            try:
                for some in _measured_all(todo, limits, executor):
                    rows += some
                    bar.update(len(some))
                    if time.monotonic() - written > EVERY:
                        rows_written(folder / ROWS, rows)
                        written = time.monotonic()
            finally:
                rows_written(folder / ROWS, rows)
    return rows


def plan(
    problems: Sequence[Problem],
    solvers: Sequence[Solver],
    settings: Sequence[Setting],
    units: Sequence[str],
    starts: Sequence[str],
) -> list[Measurement]:
    """What a study measures: a solver after the other; of each, problems in one random order.

    The steps of a sequence follow each other, as they do in the set.

    Parameters
    ----------
    problems : sequence of Problem
    solvers : sequence of Solver
    settings : sequence of Setting
    units, starts : sequence of str
    """
    groups = groups_in_random_order(problems)
    measurements = []
    for solver, setting, group, unit, start in product(solvers, settings, groups, units, starts):
        goes_on = start != COLD and len(group) > 1
        # What CVXPY has compiled takes a start with another g alone.
        starts_warm = solver.warm and not (goes_on and solver.door == CVXPY)
        if not solver.takes(setting) or (start != COLD and not starts_warm):
            continue
        steps = [replace(one, units=group[0].units) for one in group] if goes_on else group
        for one, before in zip(steps, [None, *steps], strict=False):
            last = before if goes_on else None
            measurements.append(Measurement(one, solver, setting, unit, start, last))
    return measurements


def _check(
    problems: Sequence[Problem],
    solvers: Sequence[Solver],
    settings: Sequence[Setting],
    limits: Limits,
) -> None:
    """Refuse what a study has no place for, and options that a solver would not get."""
    for one in problems:
        if one.facts["kind"] != QP:
            words = "has cones; studies contain rows only"
            raise InputError(words, field="problems", value=one.id)
    if not 0 < len({one.id for one in problems}) == len(problems):
        raise InputError("must be some, of different names", field="problems", value=len(problems))
    for solver in solvers:
        taken = [setting for setting in settings if solver.takes(setting)]
        if not taken:
            words = f"hold nothing that {solver.label} can be set to; add 'default', or give it"
            names = [setting.name for setting in settings]
            raise InputError(f"{words} options of its own", field="settings", value=names)
        if solver.door != FUNCTION:
            for setting in taken:
                options = solver.settings_of(setting, limits.time_limit)
                check_options(solver.door, solver.target, options)


def _recorded(path: Path, problems: Sequence[Problem], limits: Limits) -> None:
    """Write what a study is about, or refuse a folder of another one."""
    numbers = {one.id: _digest(one) for one in problems}
    mine: dict[str, Any] = {"limits": asdict(limits), "problems": numbers}
    there: Any = json_read(path) if path.exists() else mine
    kept = there.get("problems", {})
    same_limits = there.get("limits") == mine["limits"]
    if not same_limits or any(kept.get(name, one) != one for name, one in numbers.items()):
        words = "holds another study, of other problems or limits; choose another folder"
        raise InputError(words, file=path.parent)
    record = mine | {"problems": kept | numbers, "machine": machine()}
    text_written(path, json.dumps(record, indent=1) + "\n")


def _digest(one: Problem) -> str:
    """What tells the numbers of a problem from others of its name."""
    matrices = [part for M in (one.H, one.A) for part in (M.data, M.indices, M.indptr)]
    return fingerprint((one.g, one.b, *matrices))[:12]


def _measured_all(
    todo: Sequence[Measurement], limits: Limits, executor: Executor | None
) -> Iterator[Sequence[Row]]:
    """The rows of all measurements, as they come: one after the other, or from an executor."""
    by_solver = [list(some) for _, some in groupby(todo, key=lambda one: one.solver.label)]
    if executor is None:
        for measurements in by_solver:
            for row in measured(measurements, limits):
                yield [row]
        return
    tasks: list[tuple[object, ...]] = []
    for measurements in by_solver:
        share = replace(limits, budget=limits.budget * BLOCK / len(measurements))
        tasks += [(measurements[i : i + BLOCK], share) for i in range(0, len(measurements), BLOCK)]
    yield from results(executor, rows_of_block, tasks)


def rows_of_block(measurements: Sequence[Measurement], limits: Limits) -> list[Row]:
    """The rows of some measurements of one solver, wherever an executor calls for them."""
    return list(measured(measurements, limits))


def measured(measurements: Sequence[Measurement], limits: Limits) -> Iterator[Row]:
    """The rows of measurements of one solver, in its process.

    Parameters
    ----------
    measurements : sequence of Measurement
    limits : Limits

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    spent = 0.0
    seen: set[object] = set()
    with SolverProcess(measurements[0].solver, limits.memory) as process:
        for one in measurements:
            fields = ungraded_fields(NOT_RUN, "budget", one.problem.feasible)
            if spent <= limits.budget:
                if not process.is_there:
                    seen.clear()
                    process.start()
                begin = time.perf_counter()
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
