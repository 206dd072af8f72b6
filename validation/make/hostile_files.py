"""Spoilt files and bombs for every reader: ``python -m validation.make.hostile_files``.

Each reader of ``tests/errors/readers.py`` is given good files that are spoilt, and the bombs of
``tests/oracles/bombs.py``: it must accept or refuse each in a sentence, within 10 s of the
processor and 2 GiB more memory than before, printing nothing, and open nothing outside of the
file's folder. strace says what the kernel opens for the process and its children, MuJoCo's
included; what belongs to Python, to installed packages and to the system's libraries is left out.
Readers are run in a process that is started again if a file ends it. ``--count`` mutations, 50,000
unless it is said, from number ``--first`` on, which are added to the counts of the page of those
before (``--out``). The bombs follow those from 0 on; from -1 on they are tried alone. Exit status 1
if a file does what it must not.
"""

import os
import random
import re
import resource
import subprocess
import sys
import sysconfig
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from quasistatic_ref import QuasistaticError
from quasistatic_ref.lab import processes
from tests.errors.readers import FAMILIES, Reader
from tests.oracles.bombs import BOMBS, PLACES, outside
from validation.tools.scripts import ROOT, rows_before, script_options, show_page

SECONDS = 10.0
"""Of the processor, of a process and its children, that a file may take [s]."""
MEMORY = 2.0
"""More than before [GiB]."""
HANGING = 300
"""A file that takes so long hangs: this machine may be busy [s]."""
COLUMNS = ("files", "accepted", "refused", "faults", "slowest [s]", "most memory [GiB]")
STRACE = (
    "strace", "-f", "--seccomp-bpf", "-y", "-s", "4096", "-e", "trace=open,openat,openat2,creat",
    "-e", "signal=none",
)  # fmt: skip
"""Says which file each call of the kernel has opened, links followed."""
MARK = re.compile(r'openat\(.*"/proc/self/file (-?\d+)"')
OPENED = re.compile(r"open(?:at)?2?\(.*\) = \d+<([^>]*)>")
SYSTEM = (
    "/usr/",
    "/lib",
    "/etc/ld.so",
    "/proc/",
    "/sys/",
    "/dev/",
    "/etc/localtime",
    "/etc/locale",
)
PAGE = """# Spoilt files and bombs, for every reader

Written by `python -m validation.make.hostile_files --out FILE`, which says what must not happen.
A fault: a traceback, a warning that is printed, an end of the process, more than 10 s or 2 GiB, or
a file outside of the folder that is opened.

{tables}
"""


class Row(NamedTuple):
    """What a reader, or a bomb, came to: the columns of the page."""

    files: int = 0
    accepted: int = 0
    refused: int = 0
    faults: int = 0
    seconds: float = 0.0
    memory: float = 0.0

    def plus(self, other: "Row") -> "Row":
        """Both together."""
        sums = (a + b for a, b in zip(self[:4], other[:4], strict=True))
        return Row(*sums, max(self.seconds, other.seconds), max(self.memory, other.memory))


def readers(folder: Path) -> dict[str, Reader]:
    """All readers, each in its own folder; next to these is another."""
    found = {}
    for family in FAMILIES:
        home = folder / family.__name__
        home.mkdir()
        found |= {name: (home, reader) for name, reader in family(home).items()}
    outside(folder / "outside")
    return {
        name: Reader(str(home / reader.file), reader.good, reader.form, reader.read)
        for name, (home, reader) in found.items()
    }


def file_of_number(known: dict[str, Reader], number: int) -> tuple[str, str, Path]:
    """Write the file of a number: its row of the page, its reader, where it is."""
    names = list(known)
    if number >= 0:
        name = names[number % len(names)]
        reader = known[name]
        rng = random.Random(number)
        content = reader.form(rng, rng.choice(reader.good))
        Path(reader.file).write_bytes(content)
        return name, name, Path(reader.file)
    bombs = bomb_names(names)
    what = bombs[-1 - number]
    if what in BOMBS:
        name, made = BOMBS[what]
        path = Path(known[name].file)
        path.write_bytes(made if isinstance(made, bytes) else made())
        return what, name, path
    name, place = what.split(": ")
    path = Path(known[name].file)
    path.unlink(missing_ok=True)
    PLACES[place](path)
    return f"in the place of any file: {place}", name, path


def bomb_names(names: list[str]) -> list[str]:
    """All bombs: files, and what stands in the place of the file of each kind of reader."""
    kinds = [name for name in names if not name.startswith("answers") and name != "--set"]
    return [*BOMBS, *(f"{name}: {place}" for name in kinds for place in PLACES)]


def read(first: int, last: int, out: Path) -> None:
    """Read the files of some numbers; a line of the outcome of each."""
    warnings.simplefilter("error")
    with tempfile.TemporaryDirectory() as folder, out.open("a") as lines:
        known = readers(Path(folder))
        for number in range(first, last, 1 if first >= 0 else -1):
            row, name, path = file_of_number(known, number)
            print(f"{number}\t{row}\t{path}", end="\t", file=lines, flush=True)
            processes.reset_peak(os.getpid())
            held = processes.resident(os.getpid())
            children = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss << 10
            begun = _processor_time()
            _mark_in_trace(number)
            said = "accepted"
            try:
                known[name].read(path)
            except QuasistaticError as refusal:
                said = "refused"
                if "\n" in str(refusal) or not 0 < len(str(refusal)) <= 2000:
                    said = f"fault: sentence {str(refusal)[:100]!r}"
            except BaseException as failure:  # whatever it is, it is no sentence
                said = f"fault: {type(failure).__name__}: {str(failure)[:200]!r}"
            _mark_in_trace(-(10**9))
            seconds = _processor_time() - begun
            most = (processes.peak(os.getpid()) or 0) - held
            child = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss << 10
            memory = max(most, child if child > children else 0) / 2**30
            if said[0] != "f" and (seconds > SECONDS or memory > MEMORY):
                said = f"fault: {seconds:.1f} s, {memory:.2f} GiB"
            print(f"{seconds:.3f}\t{memory:.3f}\t{said}", file=lines, flush=True)
            if path.is_symlink() or not path.is_file():
                path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
            if known[name].good:
                path.write_bytes(known[name].good[0])


def _processor_time() -> float:
    """Time of the processor of this process and its children [s]."""
    return sum(os.times()[:4])


def _mark_in_trace(number: int) -> None:
    """Open what is not there, for strace to see where a file begins and ends."""
    try:
        os.open(f"/proc/self/file {number}", os.O_RDONLY)
    except OSError:
        return


def traced_rows(first: int, last: int, folder: Path) -> Iterator[tuple[str, Row]]:
    """The rows of files of some numbers, read in processes that strace watches."""
    at = first
    while (at < last) if first >= 0 else (at > last):
        out, log = folder / f"{at}.txt", folder / f"{at}.log"
        command = [
            *STRACE,
            "-o",
            str(log),
            sys.executable,
            "-m",
            "validation.make.hostile_files",
            f"--first={at}",
            f"--count={last - at}",
        ]
        process = subprocess.Popen(
            [*command, "--worker", str(out)], cwd=ROOT, start_new_session=True
        )
        size, changed = 0, time.monotonic()
        while process.poll() is None and time.monotonic() - changed < HANGING:
            time.sleep(0.2)
            now = out.stat().st_size if out.exists() else 0
            changed = time.monotonic() if now != size else changed
            size = now
        if process.poll() is None:
            os.killpg(process.pid, 9)
            process.wait()
        lines = out.read_text().splitlines() if out.exists() else []
        elsewhere = opened_elsewhere(log)
        done = 0
        for line in lines:
            cells = line.split("\t")
            done += 1
            hung = ("0", "0", "fault: it ended the process, or hung")
            seconds, memory, said = cells[3:] if len(cells) == 6 else hung
            if bad := elsewhere.get(int(cells[0])):
                said = f"fault: it opened {bad}"
            if said[0] == "f":
                print(cells[0], cells[1], said, file=sys.stderr, flush=True)
            outcomes = (said == "accepted", said == "refused", said[0] == "f")
            yield cells[1], Row(1, *outcomes, float(seconds), float(memory))
        if not done:
            raise SystemExit("the readers did not begin")
        at += done if first >= 0 else -done


def opened_elsewhere(log: Path) -> dict[int, str]:
    """Number of a file -> the first that was opened for it outside of its folder."""
    temporary = tempfile.gettempdir()
    kept = [ROOT, sys.prefix, sys.base_prefix, *sysconfig.get_paths().values(), *sys.path]
    allowed = (*SYSTEM, *(str(Path(one).resolve()) for one in kept if one))
    found = {}
    number = -(10**9)
    for line in log.read_text(errors="replace").splitlines():
        if mark := MARK.search(line):
            number = int(mark[1])
        opened = OPENED.search(line)
        if opened and number > -(10**9) and number not in found:
            path = opened[1]
            inside = path.startswith(temporary) and "/outside/" not in path
            if not inside and not path.startswith(allowed):
                found[number] = path
    return found


def table(title: str, rows: dict[str, Row]) -> str:
    """A table of the page, with a last row of all."""
    every = Row()
    for row in rows.values():
        every = every.plus(row)
    lines = [f"| {title} | {' | '.join(COLUMNS)} |", "|---" * (len(COLUMNS) + 1) + "|"]
    for name, row in [*sorted(rows.items()), ("all", every)]:
        counts = " | ".join(str(int(n)) for n in row[:4])
        lines.append(f"| {name} | {counts} | {row.seconds:.1f} | {row.memory:.2f} |")
    return "\n".join(lines)


def main() -> int:
    """Read all; exit status 1 if one has a fault."""
    options = script_options(__doc__, count=50000, first=0, out=Path, worker=Path)
    first = options.first
    if options.worker:
        read(first, first + options.count, options.worker)
        return 0
    rows = {
        name: Row(*map(int, cells[:4]), *map(float, cells[4:]))
        for name, cells in rows_before(options.out).items()
        if name != "all"
    }
    parts = [(first, first + options.count)] if first >= 0 else []
    if first <= 0:
        with tempfile.TemporaryDirectory() as folder:
            count = len(bomb_names(list(readers(Path(folder)))))
        begin = min(first, -1)
        parts.append((begin, -1 - count if first == 0 else max(begin - options.count, -1 - count)))
    with tempfile.TemporaryDirectory() as folder:
        for part in parts:
            for name, row in traced_rows(*part, Path(folder)):
                rows[name] = rows.get(name, Row()).plus(row)
    bombs = {name: row for name, row in rows.items() if ": " in name}
    spoilt = {name: row for name, row in rows.items() if name not in bombs}
    tables = [table(*one) for one in (("reader", spoilt), ("bomb", bombs)) if one[1]]
    show_page(PAGE.format(tables="\n\n".join(tables)), options.out)
    return int(any(row.faults for row in rows.values()))


if __name__ == "__main__":
    sys.exit(main())
