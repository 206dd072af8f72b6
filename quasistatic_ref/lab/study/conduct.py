"""Who is asked when: all solvers on one problem before the next, one process a solver.

The same loop serves the cores of this machine and a Dask cluster: both are executors that take
blocks of measurements and give back rows. There is never more than one block of a solver under way.
"""

import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass

from quasistatic_ref.lab.study.grade import NOT_RUN, ungraded
from quasistatic_ref.lab.study.keeper import Keeper
from quasistatic_ref.lab.study.plan import Measurement
from quasistatic_ref.lab.study.qp import Problem
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.lab.study.store import Row, Store
from quasistatic_ref.progress import progress_bar

Block = list[tuple[Measurement, Problem]]
Answered = Callable[[Block, float, float], list[Row]]
"""(block, time limit of a problem [s], what is left of the budget [s]) -> rows."""
BLOCK = 50
"""Measurements of a block that is sent to a cluster."""


def block_rows(keeper: Keeper, block: Block, limit: float, left: float) -> list[Row]:
    """Measure one block; a measurement beyond the budget is a row that says so.

    Parameters
    ----------
    keeper : Keeper
        Of the one solver of the block.
    block : list of (Measurement, Problem)
    limit : float
        Of one problem [s].
    left : float
        Of the solver's budget [s].

    Returns
    -------
    list of dict
    """
    rows = []
    for m, problem in block:
        if left <= 0:
            rows.append(unmeasured(m))
            continue
        begin = time.perf_counter()
        found = keeper.measured(problem, m.setting, m.units, m.warm, limit)
        spent = time.perf_counter() - begin
        left -= spent
        seconds = found["seconds"] | {"spent": spent}
        rows.append(m.fields() | found | {"seconds": seconds})
    return rows


def unmeasured(m: Measurement) -> Row:
    """The row of a measurement that the budget did not reach."""
    row = ungraded(NOT_RUN, "not run (budget)", 0.0)
    return m.fields() | row | {"seconds": row["seconds"] | {"spent": 0.0}}


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
    limit, budget : float
        Of a problem, and of a solver [s].
    progress : bool
    """

    store: Store
    todo: Sequence[Measurement]
    problems: Mapping[str, Problem]
    folder: str
    limit: float
    budget: float
    progress: bool = True


def conduct(
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
        Measurements of a block; at least those of one problem.
    """
    queues: dict[str, deque[tuple[int, Measurement]]] = {}
    for place, m in enumerate(work.todo):
        queues.setdefault(m.solver.label, deque()).append((place, m))
    left = {label: work.budget - spent for label, spent in _spent(work.store, queues).items()}
    under_way: dict[Future[list[Row]], str] = {}
    total = len(work.todo)
    with progress_bar(total=total, unit="call", words="asked", shown=work.progress) as bar:
        try:
            while queues or under_way:
                idle = {n: q for n, q in queues.items() if n not in under_way.values()}
                while idle and len(under_way) < slots:
                    label = min(idle, key=lambda name: idle[name][0][0])
                    taken = _taken(idle.pop(label), block)
                    if not queues[label]:
                        del queues[label]
                    items = [(m, work.problems[m.problem]) for m in taken]
                    call = answered(taken[0].solver)
                    under_way[executor.submit(call, items, work.limit, left[label])] = label
                done, _ = wait(under_way, return_when=FIRST_COMPLETED)
                for future in done:
                    label = under_way.pop(future)
                    for row in future.result():
                        work.store.add(row)
                        left[label] -= row["seconds"]["spent"]
                        bar.update()
        finally:
            for future in under_way:
                future.cancel()


def conduct_here(work: Work, jobs: int) -> None:
    """The same on the cores of this machine, one process for each of `jobs` solvers at once."""
    keepers: dict[str, Keeper] = {}

    def answered(solver: Solver) -> Answered:
        keeper = keepers.setdefault(solver.label, Keeper(solver, work.folder))
        return lambda block, limit, left: block_rows(keeper, block, limit, left)

    try:
        with ThreadPoolExecutor(jobs) as executor:
            conduct(work, executor, jobs, answered)
    finally:
        for keeper in keepers.values():
            keeper.close()


def _taken(queue: deque[tuple[int, Measurement]], block: int) -> list[Measurement]:
    """Take the next measurements of one solver: whole problems, at least `block` in number."""
    taken: list[Measurement] = []
    while queue:
        m = queue[0][1]
        new = not taken or (m.problem, m.repetition) != (taken[-1].problem, taken[-1].repetition)
        if new and len(taken) >= block:
            break
        taken.append(queue.popleft()[1])
    return taken


def _spent(store: Store, labels: Mapping[str, object]) -> dict[str, float]:
    """Seconds that each solver has used, of the rows that are there."""
    spent = dict.fromkeys(labels, 0.0)
    for row in store.rows:
        label = f"{row['interface']}:{row['solver']}"
        if label in spent:
            spent[label] += row["seconds"]["spent"]
    return spent
