"""Long maps: many calls, some at once, whose records are kept so that a run can go on."""

import json
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from multiprocessing import get_context
from os import cpu_count
from pathlib import Path
from typing import Any, TypeVar

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, json_text, text_of, text_written

Result = TypeVar("Result")
Record = dict[str, Any]


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


class Log:
    """Records of a long run, one JSON object a line; a last line that was cut off is dropped.

    Parameters
    ----------
    path : Path or None
        None: nothing is kept.
    key : callable
        Record -> what it is known by.
    head : mapping, optional
        The first line: the settings with which the records are made.

    Raises
    ------
    InputError
        If the file is none of such records, or they were made with other settings.
    """

    def __init__(
        self,
        path: Path | None,
        key: Callable[[Record], Hashable],
        head: Mapping[str, Any] | None = None,
    ) -> None:
        self._path = path
        self._key = key
        first = [] if head is None else [json.loads(json_text(head))]
        there = records_read(path) if path is not None and path.exists() else list(first)
        if there[: len(first)] != first:
            problem = "holds records that were made with other settings; choose another folder "
            raise InputError(f"{problem}with --out, or remove it", file=path)
        try:
            self.found = {key(one): one for one in there[len(first) :]}
        except (KeyError, TypeError):
            raise InputError(STRANGE, file=path) from None
        if path is not None:
            text_written(path, lines([*first, *self.found.values()]))

    def add(self, *records: Record) -> None:
        """Keep records; they are in the file when this returns."""
        self.found |= {self._key(one): one for one in records}
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(lines(records))

    def records(self, keys: Iterable[Any], record: Callable[[Any], Record]) -> Iterator[Record]:
        """The record of each key; one that is not there is made and added."""
        for key in keys:
            if key not in self.found:
                self.add(record(key))
            yield self.found[key]


STRANGE = "holds something else than such records; remove it, or choose another with --out"


def lines(records: Iterable[Record]) -> str:
    """Records as text, one JSON object a line."""
    return "".join(json_text(one) + "\n" for one in records)


def records_read(path: Path) -> list[Record]:
    """The records of a file; a last line that was cut off is left out.

    Raises
    ------
    InputError
        If a line is no JSON.
    """
    text = text_of(bytes_read(path), path)
    try:
        return [json.loads(line) for line in text.split("\n")[:-1]]
    except (ValueError, RecursionError):
        raise InputError(STRANGE, file=path) from None
