"""The process in which spoilt files are read: the kernel ends it where a reader does not return."""

from __future__ import annotations

import json
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from quasistatic_ref.errors import QuasistaticError


@dataclass(frozen=True)
class Reader:
    """What reads one kind of file.

    Parameters
    ----------
    file : str
        Name of the file that it reads.
    good : tuple of bytes
        Files that it accepts.
    form : callable
        How they are made wrong.
    read : callable
        Given the path of the file; what it returns is noted.
    """

    file: str
    good: tuple[bytes, ...]
    form: Callable[[random.Random, bytes], bytes]
    read: Callable[[Path], object]


SECONDS = 10.0
"""Most processor time of one input [s]: the machine may have other work."""
WAITED = 120.0
"""Most time of one input [s], for one that waits rather than works."""
MEBIBYTES = 2048.0
"""Most memory of the process [MiB]."""
ADDRESSES = 12 * 2**30
"""Most addresses of the process [bytes]: what asks for more fails rather than fill the machine."""
LONGEST = 2000
"""Most characters of a sentence."""
OUTCOMES = ("accepted", "refused", "traceback", "crash", "hang", "memory")
ENDED = {signal.SIGPROF: "hang", signal.SIGALRM: "hang", signal.SIGKILL: "memory"}
"""What the signal says that ended a process; all others are crashes."""


def scratch() -> tempfile.TemporaryDirectory[str]:
    """A temporary folder, in memory where there is such a place: disks cost 3 ms a file."""
    memory = Path("/dev/shm")
    return tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None)


def content_of(reader: Reader, i: int) -> bytes:
    """The i-th input of a reader: the same for all readers of files of that name."""
    rng = random.Random(f"{reader.file}/{i}")
    return reader.form(rng, rng.choice(reader.good))


def outcome_of(read: Callable[[Path], object], path: Path) -> tuple[str, str]:
    """What a reader makes of a file, and what it says."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            said = read(path)
    except QuasistaticError as refusal:
        sentence = str(refusal)
        if "bad_alloc" in sentence:
            return "memory", sentence
        if not sentence or "\n" in sentence or len(sentence) > LONGEST:
            return "traceback", f"no sentence: {sentence[:200]}"
        return "refused", sentence
    except MemoryError as error:
        return "memory", repr(error)
    except BaseException as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(last.filename).name}:{last.lineno}"
        return "traceback", f"{type(error).__name__} in {where}: {str(error)[:200]}"
    return "accepted", str(said or "")


def peak() -> float:
    """Most memory of this process since the call before [MiB]."""
    status = Path("/proc/self/status").read_text()
    most = next(line for line in status.splitlines() if line.startswith("VmHWM"))
    Path("/proc/self/clear_refs").write_text("5")
    return int(most.split()[1]) / 1024


def main() -> None:
    """Arguments: jobs ``[[reader, start, count], ...]``, module of the readers, limit of time."""
    out = os.fdopen(os.dup(1), "w", buffering=1)
    with open(os.devnull, "w") as nowhere:  # libraries print what they please
        os.dup2(nowhere.fileno(), 1)
        os.dup2(nowhere.fileno(), 2)
    with scratch() as folder:
        try:
            table = import_module(sys.argv[2]).readers(Path(folder))
            for found in findings(table, Path(folder), json.loads(sys.argv[1]), float(sys.argv[3])):
                out.write(json.dumps(found) + "\n")
        except Exception:
            out.write(json.dumps({"mistake": traceback.format_exc()}) + "\n")


def findings(
    table: Mapping[str, Reader], folder: Path, jobs: Iterable[tuple[str, int, int]], seconds: float
) -> Iterator[list[object]]:
    """``[reader, i, outcome, seconds, MiB, words]`` of each input, in turn."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    for name, start, count in jobs:
        reader = table[name]
        path = folder / reader.file
        for good in reader.good:
            path.write_bytes(good)
            outcome, said = outcome_of(reader.read, path)
            if outcome != "accepted":
                raise AssertionError(f"{name}: a good file is not accepted: {said}")
        peak()
        for i in range(start, start + count):
            path.write_bytes(content_of(reader, i))
            signal.setitimer(signal.ITIMER_PROF, seconds)
            signal.setitimer(signal.ITIMER_REAL, WAITED)
            begun = time.process_time()
            outcome, said = outcome_of(reader.read, path)
            spent, most = time.process_time() - begun, peak()
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.setitimer(signal.ITIMER_REAL, 0)
            yield [name, i, "memory" if most > MEBIBYTES else outcome, spent, most, said]
        path.write_bytes(reader.good[0])


if __name__ == "__main__":
    main()
