"""Processes: how one ends, and what Linux knows of the memory of one and of its children."""

import contextlib
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

PROC = Path("/proc")
PAGE = os.sysconf("SC_PAGE_SIZE")


@contextlib.contextmanager
def ends_in_order() -> Iterator[None]:
    """A block that SIGTERM and SIGHUP end as an error does: what it started is ended with it."""
    signals = [signal.SIGTERM, signal.SIGHUP]
    before = [signal.signal(one, lambda number, _: sys.exit(128 + number)) for one in signals]
    try:
        yield
    finally:
        for one, handler in zip(signals, before, strict=True):
            signal.signal(one, handler)


def descendants(pid: int) -> list[int]:
    """The children of a process, theirs, and so on."""
    pids: list[int] = []
    for child in _children(pid):
        pids += [child, *descendants(child)]
    return pids


def resident(pid: int) -> int:
    """Resident memory of a process and of its descendants [bytes]; 0 where it is not known."""
    return sum(_resident(one) for one in (pid, *descendants(pid)))


def _children(pid: int) -> Iterator[int]:
    with contextlib.suppress(OSError):
        for task in (PROC / str(pid) / "task").iterdir():
            with contextlib.suppress(OSError):
                yield from map(int, (task / "children").read_text().split())


def _resident(pid: int) -> int:
    try:
        return PAGE * int((PROC / str(pid) / "statm").read_text().split()[1])
    except (OSError, IndexError, ValueError):
        return 0
