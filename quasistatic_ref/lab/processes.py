"""What Linux knows of a process: its memory, its children, also those that detached.

On other systems there is no `/proc`: memory is not known, and only the process's own group ends.
"""

import contextlib
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

PROC = Path("/proc")
TOKEN = "QUASISTATIC_REF_SUPERVISED"
"""Variable of the environment by which children of a process are known when it has ended."""
STARTING = 1.0
"""How long processes are waited for whose environment is still empty [s]."""
PAGE = os.sysconf("SC_PAGE_SIZE")


def descendants(pid: int) -> list[int]:
    """The children of a process, theirs, and so on."""
    found: list[int] = []
    for child in _children(pid):
        found += [child, *descendants(child)]
    return found


def detached_processes(pid: int) -> list[int]:
    """Those descendants that have left the session of a process that leads one."""
    return [child for child in descendants(pid) if _session(child) not in (pid, None)]


def marked_processes(token: str) -> list[int]:
    """Processes whose environment has a token, wherever they are."""
    words = f"{TOKEN}={token}".encode()
    end = time.monotonic() + STARTING
    found = []
    for folder in PROC.glob("[0-9]*"):
        with contextlib.suppress(OSError):
            while not (environment := (folder / "environ").read_bytes()) and time.monotonic() < end:
                time.sleep(1e-3)  # the process is being started
            if words in environment.split(b"\0"):
                found.append(int(folder.name))
    return [pid for pid in found if pid != os.getpid()]


def end(pids: list[int]) -> None:
    """Kill processes."""
    for pid in pids:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.kill(pid, signal.SIGKILL)


def resident(pid: int) -> int:
    """Resident memory of a process and of its descendants [bytes]; 0 where it is not known."""
    return sum(_resident(one) for one in (pid, *descendants(pid)))


def _children(pid: int) -> Iterator[int]:
    with contextlib.suppress(OSError):
        for task in (PROC / str(pid) / "task").iterdir():
            with contextlib.suppress(OSError):
                yield from map(int, (task / "children").read_text().split())


def _session(pid: int) -> int | None:
    try:
        return os.getsid(pid)
    except OSError:
        return None


def _resident(pid: int) -> int:
    try:
        return PAGE * int((PROC / str(pid) / "statm").read_text().split()[1])
    except (OSError, IndexError, ValueError):
        return 0
