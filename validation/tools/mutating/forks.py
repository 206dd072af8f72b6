"""Jobs, each in a fork of this process that has limits of its own."""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import tempfile
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

Job = Callable[[], Any]

WALL = 600
"""Seconds after which a job that waits for something is ended."""
MEMORY = 8 << 30
"""Bytes that a job may gather: a mutant may loop."""


def forked(jobs: Iterable[tuple[Any, Job]], workers: int) -> Iterator[tuple[Any, Any]]:
    """The name of each job with what it returns, as they end, `workers` at a time.

    What a job returns comes as JSON; of a job that is ended by a signal, the number of the signal
    as an int.

    Raises
    ------
    RuntimeError
        If a job raises; the message has its traceback.
    """
    with tempfile.TemporaryDirectory() as temporary:
        running: dict[int, tuple[Any, Path]] = {}
        for k, (name, job) in enumerate(jobs):
            if len(running) == workers:
                yield _ended(running)
            folder = Path(temporary) / str(k)
            folder.mkdir()
            child = os.fork()
            if not child:
                _run(job, folder)
            running[child] = name, folder
        while running:
            yield _ended(running)


def more_time(seconds: float) -> None:
    """Let this process use so many more seconds of the processor from now on."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    limit = int(used.ru_utime + used.ru_stime + seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))


def _run(job: Job, folder: Path) -> None:
    """Do a job, write what it returns, and end the process."""
    try:
        signal.alarm(WALL)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        nothing = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):
            os.dup2(nothing, stream)
        os.environ["PYTEST_DEBUG_TEMPROOT"] = str(folder)  # two at a time would share one
        (folder / "result.json").write_text(json.dumps(job()))
        os._exit(os.EX_OK)
    except BaseException:
        (folder / "error.txt").write_text(traceback.format_exc())
    finally:
        os._exit(os.EX_SOFTWARE)


def _ended(running: dict[int, tuple[Any, Path]]) -> tuple[Any, Any]:
    """Wait for one of the running jobs."""
    child, status = os.wait()
    while child not in running:  # a process that a test module has started on import
        child, status = os.wait()
    name, folder = running.pop(child)
    if os.WIFSIGNALED(status):
        said = int(os.WTERMSIG(status))
    elif status:
        raise RuntimeError(f"a job failed:\n{(folder / 'error.txt').read_text()}")
    else:
        said = json.loads((folder / "result.json").read_text())
    shutil.rmtree(folder, ignore_errors=True)
    return name, said
