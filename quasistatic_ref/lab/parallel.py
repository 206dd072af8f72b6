"""Many calls of a function, some at once."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from multiprocessing import get_context
from os import cpu_count
from typing import Any, TypeVar

Result = TypeVar("Result")


class InThisProcess(Executor):
    """An executor that makes each call when it is submitted."""

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> Future[Result]:
        """Make a call; what it raises is raised where its result is taken, but for Ctrl-C."""
        future: Future[Result] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


def workers(jobs: int | None) -> Executor:
    """What makes `jobs` calls at once: processes, or this one for a single job.

    Parameters
    ----------
    jobs : int or None
        None: as many as there are cores.
    """
    jobs = jobs or cpu_count() or 1
    if jobs == 1:
        return InThisProcess()
    return ProcessPoolExecutor(jobs, mp_context=get_context("spawn"))


def results(
    executor: Executor, slots: int, call: Callable[..., Result], tasks: Sequence[tuple[object, ...]]
) -> Iterator[Result]:
    """Call a function with the arguments of each task; what is not yet called for waits here.

    Parameters
    ----------
    executor : Executor
    slots : int
        Calls under way at once.
    call : callable
    tasks : sequence of tuple
    """
    left = list(reversed(tasks))
    under_way: set[Future[Result]] = set()
    while left or under_way:
        while left and len(under_way) < slots:
            under_way.add(executor.submit(call, *left.pop()))
        done, under_way = wait(under_way, return_when=FIRST_COMPLETED)
        for future in done:
            yield future.result()
