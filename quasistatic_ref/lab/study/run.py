"""A study: what is measured, in which order, and how a study that was stopped goes on."""

import json
import statistics
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from functools import cache
from itertools import groupby, product
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.lock import locked
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.parallel import results
from quasistatic_ref.lab.study.grade import facts_of_reply, no_reply
from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.problems.names import NATURAL, UNITS
from quasistatic_ref.lab.study.problems.selection import in_random_order, problems_taken
from quasistatic_ref.lab.study.program import Known
from quasistatic_ref.lab.study.row import Row, key_of
from quasistatic_ref.lab.study.solvers import Setting, Solver, settings_of, solvers_of
from quasistatic_ref.lab.study.store import ROWS, rows_read, rows_written
from quasistatic_ref.lab.study.worker import Ended, Question, SolverProcess
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.text.content import json_read, text_written
from quasistatic_ref.text.json_text import json_text
from quasistatic_ref.text.plain import fingerprint

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
    problem : Known
    solver : Solver
    setting : Setting
    units : str
    """

    problem: Known
    solver: Solver
    setting: Setting
    units: str

    def row(self, limits: Limits, facts: dict[str, Any]) -> Row:
        """The row of this call, with the facts of what came back.

        Parameters
        ----------
        limits : Limits
        facts : dict
            The fields that :func:`.facts_of_reply` returns, and seconds.
        """
        problem = self.problem
        program = problem.program
        options, accuracy = self.solver.asked(self.setting, limits.time_limit)
        return Row(
            problem=problem.id,
            family=problem.family,
            n=len(program.g),
            m=len(program.b),
            dial=problem.dial,
            feasible=problem.feasible,
            solver=self.solver.name,
            door=self.solver.door,
            version=self.solver.version,
            setting=self.setting.name,
            accuracy=accuracy,
            options=json_text(options),
            units=self.units,
            machine=processor(),
            **facts,
        )

    def key(self, limits: Limits) -> tuple[str, ...]:
        """The attributes that identify this call among all of a study."""
        return key_of(self.row(limits, no_reply("", None, 0.0)))


@cache
def processor() -> str:
    """The processor of this machine."""
    return str(machine()["processor"])


def study(
    problems: Mapping[str, int] | Sequence[Known],
    solvers: Sequence[str | Callable[..., Any] | Solver],
    settings: Sequence[str | Setting] = ("default",),
    folder: str | Path = "study",
    executor: Executor | None = None,
    *,
    units: Sequence[str] = (NATURAL,),
    limits: Limits | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run what is left of a study: each problem by each solver and setting, a row a call.

    Parameters
    ----------
    problems : mapping of str to int, or sequence of Known
        How many of each family of contact-qp; or problems, such as :func:`.problems_taken` and
        :func:`.problems_of_runs` return, or any objects with the attributes of :class:`.Known`.
    solvers : sequence of str, callable or Solver
        ``"qpsolvers:NAME"``, ``"cvxpy:NAME"``, ``*`` for every NAME that is installed; functions
        ``(P, q, G, h) -> (x, z, status)``; what :func:`.function_solver` returns.
    settings : sequence of str or Setting
        Of ``"default"``, ``"low"``, ``"mid"``, ``"high"``, ``"tuned"``; or others.
    folder : str or Path
        Of the rows. A call whose row is there is not made again.
    executor : Executor, optional
        Any of ``concurrent.futures``, which calls at several places at once; by default one call
        after the other, so that none disturbs the times of another. Wherever it is, each solver has
        a process of its own with limits of time and memory.
    units : sequence of str
        Of ``"raw"``, as the problems are given, and ``"natural"``.
    limits : Limits, optional
    progress : bool

    Returns
    -------
    list of Row
        All rows of the folder. Calls that a solver's budget did not reach have none.

    Raises
    ------
    InputError
        If an argument is unusable, or the folder holds another study or is being written: before
        anything is called.
    KeyboardInterrupt
        After Ctrl-C; the rows until then are kept.
    """
    limits = limits or Limits()
    if isinstance(problems, Mapping):
        problems = problems_taken(problems)
    chosen = solvers_of(solvers)
    at = settings_of(settings)
    _check(problems, chosen, at)
    for value in units:
        if value not in UNITS:
            raise InputError(f"must be one of {', '.join(UNITS)}", field="units", value=value)
    wanted = plan(problems, chosen, at, units)
    numbers = {one.id: fingerprint(tuple(one.program))[:12] for one in problems}
    folder = Path(folder)
    with locked(folder):
        _recorded(folder / RECORD, numbers, limits)
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
    problems: Sequence[Known],
    solvers: Sequence[Solver],
    settings: Sequence[Setting],
    units: Sequence[str],
) -> list[Measurement]:
    """The calls of a study: a solver after the other; of each, problems in one random order.

    Parameters
    ----------
    problems : sequence of Known
    solvers : sequence of Solver
    settings : sequence of Setting
    units : sequence of str
    """
    order = in_random_order(problems)
    return [
        Measurement(problem, solver, setting, unit)
        for solver, setting, problem, unit in product(solvers, settings, order, units)
        if solver.takes(setting)
    ]


def _check(
    problems: Sequence[Known], solvers: Sequence[Solver], settings: Sequence[Setting]
) -> None:
    """Refuse what a study has no place for."""
    if not 0 < len({one.id for one in problems}) == len(problems):
        raise InputError("must be some, of different names", field="problems", value=len(problems))
    for solver in solvers:
        if not any(solver.takes(setting) for setting in settings):
            words = f"hold nothing that {solver.label} can be set to; add 'default', or give it"
            names = [setting.name for setting in settings]
            raise InputError(f"{words} options of its own", field="settings", value=names)


def _recorded(path: Path, numbers: Mapping[str, str], limits: Limits) -> None:
    """Write what a study is about, or refuse a folder of another one.

    Parameters
    ----------
    path : Path
    numbers : mapping of str to str
        What tells the numbers of a problem from others of its name.
    limits : Limits
    """
    mine: dict[str, Any] = {"limits": asdict(limits), "problems": numbers}
    there: Any = json_read(path) if path.exists() else mine
    kept = there.get("problems", {})
    same_limits = there.get("limits") == mine["limits"]
    if not same_limits or any(kept.get(name, one) != one for name, one in numbers.items()):
        words = "holds another study, of other problems or limits; choose another folder"
        raise InputError(words, file=path.parent)
    record = mine | {"problems": kept | numbers, "machine": machine()}
    text_written(path, json.dumps(record, indent=1) + "\n")


def _measured_all(
    todo: Sequence[Measurement], limits: Limits, executor: Executor | None
) -> Iterator[Sequence[Row]]:
    """The rows of all measurements, as an executor, or this process, finishes them."""
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
    """The rows of some measurements of one solver, measured in this process."""
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
            if spent > limits.budget:
                return
            if not process.is_there:
                seen.clear()
                process.start()
            begin = time.perf_counter()
            facts = _facts(process, one, limits, seen)
            spent += time.perf_counter() - begin
            yield one.row(limits, facts)


def _facts(
    process: SolverProcess, one: Measurement, limits: Limits, seen: set[object]
) -> dict[str, Any]:
    """What one measurement finds, as fields of its row."""
    program = one.problem.program
    if one.units == NATURAL:
        program = program.natural(one.problem.units)
    options, accuracy = one.solver.asked(one.setting, limits.time_limit)
    question = Question(program, options)
    shape = (*program.A.shape, program.equations, one.setting.name, one.units)
    try:
        if shape not in seen:  # a solver may compile at the first call of a shape
            process.ask(question, limits.warm_up)
            seen.add(shape)
        reply, times = process.ask(question, limits.time_limit)
        if limits.repetitions > 1 and reply.solved:
            many = replace(question, calls=limits.repetitions - 1)
            times += process.ask(many, limits.repetitions * limits.time_limit).times
    except Ended as end:
        return no_reply(str(end), accuracy, end.seconds)
    facts = facts_of_reply(one.problem, one.units, reply, one.solver, accuracy)
    return facts | {"seconds": statistics.median(times)}
