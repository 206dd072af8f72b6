"""Many calls of a function, some at once, by any executor of ``concurrent.futures``."""

import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from threading import Thread
from types import ModuleType
from typing import TypeVar

Result = TypeVar("Result")


@contextmanager
def workers(jobs: int | None) -> Iterator[Executor | None]:
    """An executor of `jobs` processes, which end with this one; None for a single job.

    A call must be a function of a module: scripts need no ``__main__`` guard, since these processes
    do not import them.

    Parameters
    ----------
    jobs : int or None
        None: as many as there are cores.
    """
    jobs = jobs or os.cpu_count() or 1
    if jobs == 1:
        yield None
        return
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")  # what a process that is spawned imports
    try:
        with ProcessPoolExecutor(jobs, get_context("spawn"), begin_worker) as pool:
            yield pool
    finally:
        sys.modules["__main__"] = main


def begin_worker() -> None:
    """End this process with its parent, and at Ctrl-C, which both get, without a traceback."""
    signal.signal(signal.SIGINT, lambda *_: os._exit(1))
    end_with_parent()


def end_with_parent() -> None:
    """End this process as soon as the one that started it has ended, in whatever way."""
    Thread(target=_wait_and_end, daemon=True).start()


def _wait_and_end() -> None:
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def results(
    executor: Executor | None, call: Callable[..., Result], tasks: Sequence[tuple[object, ...]]
) -> Iterator[Result]:
    """Call a function with the arguments of each task; its results as they come.

    Parameters
    ----------
    executor : Executor or None
        None: one call after the other, in this process.
    call : callable
    tasks : sequence of tuple
    """
    if executor is None:
        for task in tasks:
            yield call(*task)
        return
    left = {executor.submit(call, *task) for task in tasks}
    try:
        for future in as_completed(left):
            left.discard(future)
            yield future.result()
    finally:
        for future in left:
            future.cancel()
