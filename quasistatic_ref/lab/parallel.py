"""Many calls on an executor, some at once; their results as they come."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import TypeVar

Result = TypeVar("Result")


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
