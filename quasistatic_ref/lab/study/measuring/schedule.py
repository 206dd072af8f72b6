"""Which solver is called when: all solvers on one problem before the next, one process a solver.

The same loop serves the cores of this machine and a Dask cluster: both are executors that take
blocks of measurements and give back rows. There is never more than one block of a solver under way.
"""

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from itertools import groupby

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.calling.solvers import Setting, Solver
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.grade import not_run
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import measured_row, sequence_measured
from quasistatic_ref.lab.study.measuring.plan import Measurement
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.store.rows import Row, label_of
from quasistatic_ref.lab.study.store.store import Store
from quasistatic_ref.simulate.progress import progress_bar

Block = list[tuple[Measurement, Problem]]
Left = tuple[float, float]
"""What is left of a solver's budget: for calls, and for starts and calls that warm up [s]."""
Answered = Callable[[Block, Limits, Left], list[Row]]
"""(block, what a call may take, what is left of the budget) -> rows."""
BLOCK = 50
"""Measurements of a block that is sent to a cluster."""


def block_rows(keeper: Keeper, block: Block, limits: Limits, left: Left) -> list[Row]:
    """Measure one block; a measurement beyond the budget is a row that says so.

    Parameters
    ----------
    keeper : Keeper
        Of the one solver of the block.
    block : list of (Measurement, Problem)
    limits : Limits
    left : (float, float)
        Of the solver's budget [s].

    Returns
    -------
    list of dict

    Raises
    ------
    InputError
        If the solver cannot be imported.
    """
    rows: list[Row] = []
    for _, some in groupby(block, key=lambda item: item[0].together):
        rows += _measured_together(keeper, list(some), limits, _less(left, rows))
    return rows


def _measured_together(keeper: Keeper, block: Block, limits: Limits, left: Left) -> list[Row]:
    """The measurements of one problem, or of one sequence."""
    first = block[0][0]
    problems = [problem for _, problem in block]
    if first.mode and min(left) > 0:
        found = sequence_measured(keeper, problems, first.setting, first.units, first.mode, limits,
                                  left[0])  # fmt: skip
        return [m.fields() | row for (m, _), row in zip(block, found, strict=True)]
    rows: list[Row] = []
    for m, problem in block:
        if min(_less(left, rows)) <= 0:
            row = not_run(problem.feasible)
        else:
            row = measured_row(keeper, problem, m.setting, m.units, m.warm, limits)
        rows.append(m.fields() | row)
    return rows


def _less(left: Left, rows: Iterable[Row]) -> Left:
    """What rows leave of a budget."""
    calls, warming = left
    for row in rows:
        seconds = row["seconds"]
        calls -= seconds["spent"]
        warming -= (seconds["start"] or 0.0) + (seconds["warm_up"] or 0.0)
    return calls, warming


@dataclass(frozen=True, eq=False)
class Work:
    """What is left of a plan, and what it may cost.

    Parameters
    ----------
    store : Store
        What rows are added to.
    todo : sequence of Measurement
        In order; those of one solver stay in it.
    problems : mapping of str to Problem
    folder : str
        Where callables and executables are looked for.
    limits : Limits
    progress : bool
    unreached : dict of str to str
        Solvers that could not be imported, or refuse an option, with the reason; they are found
        out on the way.
    """

    store: Store
    todo: Sequence[Measurement]
    problems: Mapping[str, Problem]
    folder: str
    limits: Limits
    progress: bool = True
    unreached: dict[str, str] = field(default_factory=dict)

    def settings_of(self, solver: Solver) -> tuple[Setting, ...]:
        """The settings at which a solver is called."""
        own = (m.setting for m in self.todo if m.solver.label == solver.label)
        return tuple(dict.fromkeys(own))


def measure_all(
    work: Work,
    executor: Executor,
    slots: int,
    answered: Callable[[Solver], Answered],
    block: int = 1,
) -> None:
    """Run what is left of a plan and add its rows to the store.

    Parameters
    ----------
    work : Work
    executor : Executor
    slots : int
        Blocks under way at once.
    answered : callable
        Solver -> the function that the executor calls.
    block : int
        Measurements of a block; at least those of one problem, or of one sequence.
    """
    queues: dict[str, deque[tuple[int, Measurement]]] = {}
    for place, m in enumerate(work.todo):
        queues.setdefault(m.solver.label, deque()).append((place, m))
    left = _left_budgets(work, queues)
    under_way: dict[Future[list[Row]], str] = {}
    total = len(work.todo)
    with progress_bar(total=total, unit="call", words="calls made", shown=work.progress) as bar:
        try:
            while queues or under_way:
                idle = {n: q for n, q in queues.items() if n not in under_way.values()}
                while idle and len(under_way) < slots:
                    label = min(idle, key=lambda name: idle[name][0][0])
                    taken = _next_measurements(idle.pop(label), block)
                    if not queues[label]:
                        del queues[label]
                    items = [(m, work.problems[m.problem]) for m in taken]
                    call = answered(taken[0].solver)
                    under_way[executor.submit(call, items, work.limits, left[label])] = label
                done, _ = wait(under_way, return_when=FIRST_COMPLETED)
                for future in done:
                    label = under_way.pop(future)
                    try:
                        rows = future.result()
                    except InputError as error:  # which costs this solver, and no other
                        work.unreached[label] = error.problem
                        bar.update(1 + len(queues.pop(label, ())))
                        continue
                    work.store.add(*rows)
                    bar.update(len(rows))
                    left[label] = _less(left[label], rows)
        finally:
            for future in under_way:
                future.cancel()


def measure_here(work: Work, jobs: int) -> None:
    """The same on the cores of this machine, one process for each of `jobs` solvers at once."""
    keepers: dict[str, Keeper] = {}

    def answered(solver: Solver) -> Answered:
        if solver.label not in keepers:
            settings = work.settings_of(solver)
            keepers[solver.label] = Keeper(solver, work.folder, work.limits.memory, settings)
        keeper = keepers[solver.label]
        return lambda block, limits, left: block_rows(keeper, block, limits, left)

    try:
        with ThreadPoolExecutor(jobs) as executor:
            measure_all(work, executor, jobs, answered)
    finally:
        for keeper in keepers.values():
            keeper.close()


def _next_measurements(queue: deque[tuple[int, Measurement]], block: int) -> list[Measurement]:
    """Take the next measurements of one solver: whole problems or sequences, at least `block`."""
    taken: list[Measurement] = []
    while queue:
        m = queue[0][1]
        new = not taken or m.together != taken[-1].together
        if new and len(taken) >= block:
            break
        taken.append(queue.popleft()[1])
    return taken


def _left_budgets(work: Work, labels: Iterable[str]) -> dict[str, Left]:
    """What each solver has left of its budget after the rows that are there."""
    own: dict[str, list[Row]] = {label: [] for label in labels}
    for row in work.store.rows:
        if (label := label_of(row)) in own:
            own[label].append(row)
    whole = work.limits.budget, work.limits.budget
    return {label: _less(whole, rows) for label, rows in own.items()}
