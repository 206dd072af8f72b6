"""Commands that are killed at random instants: ``python -m validation.make.kills``.

``run``, ``run --sweep``, ``study run``, ``vectors generate`` and ``demo``, small ones, are started
and ended by SIGKILL, or by SIGINT in every fourth case, ``--count`` times each (500 unless it is
said). After each the same command is given again, and then, if it is refused, the one that its
message names (``--resume``), until it ends well. Then the folder must have the same results, to the
last bit but for times, as one of a run that was let alone, and nothing else. Of every tenth run a
second one is started on the same folder. Counts are added to those of the page of before
(``--out``); ``--only`` one command. Exit status 1 if something was lost. Commands run in copies of
this process, which has one thread and all modules, so that most instants lie in their work.
"""

import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import redirect_stdout, suppress
from pathlib import Path
from threading import RLock
from typing import NamedTuple

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}

import numpy as np
from tqdm import tqdm

from quasistatic_ref.cli.main import main as command
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.folders import vectors_folder
from quasistatic_ref.lab.study.store.rows import MACHINE_DEPENDENT
from quasistatic_ref.lab.study.store.store import STORE, contents
from validation.tools.scripts import rows_before, script_options, show_page

COLUMNS = ("killed", "interrupted", "ended before", "resumed", "second ones refused", "lost")
MOST = 5
"""Commands after the first one that a folder may need."""
CASES = 2
"""Of each layer of the vectors."""
RUN = ["run", "sphere_spin", "--set", "steps=15", "--save-every", "0"]
SWEEP = [*RUN[:3], "steps=4", "--jobs", "1", "--sweep", "h=0.02,0.01"]
SWEEP += ["--sweep", "contacts.floor.mu_omega=0,0.01"]
STUDY = """format = "quasistatic-ref/study"
version = 1
kind = "solvers"
time_limit = 20.0
[problems]
seed = 3
scenarios = ["sphere_spin"]
families = { scenarios = 2 }
[[runs]]
solvers = ["qpsolvers:clarabel"]
"""
DEMO = ["demo", "--fast", "--set", "h=0.1", "--set", "steps=30"]
PAGE = """# Commands that are killed at random instants

Written by `python -m validation.make.kills --out FILE`, which says what is compared. `resumed`:
folders that were made whole by the command that a message names. `lost`: folders that were not made
whole, or whose bits differ from those of a command that was let alone.

| command | {columns} |
|---|{lines}|
{rows}
"""


class Folders(NamedTuple):
    """Of the results, and of the files that commands read."""

    out: Path
    inputs: Path


def child_of(words: list[str], output: Path) -> int:
    """A copy of this process that runs a command, in a session of its own; its number."""
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # until it cannot leave the copy
    child = os.fork()
    if not child:
        status = 70
        try:
            os.setsid()
            signal.signal(signal.SIGINT, signal.default_int_handler)
            written = os.open(output, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(written, 1)
            os.dup2(written, 2)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
            status = command([*words, "--quiet"])
        finally:
            os._exit(status)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    return child


def exit_status(child: int) -> int:
    """The exit status of a process, negative where a signal ended it; its children end, too."""
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    return status


def digest(folder: Path) -> dict[str, object]:
    """What a folder holds that is not a time, by the names of files: nothing half written."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if not path.is_file():
            continue
        name = path.relative_to(folder).as_posix()
        if path.suffix == ".npz":
            with np.load(path) as arrays:
                of_program = [k for k in arrays if not k.startswith(("seconds", "header"))]
                found[name] = {key: arrays[key].tobytes() for key in of_program}
        elif path.name == STORE:
            rows = contents(folder).rows
            found[name] = [
                {k: v for k, v in row.items() if k not in MACHINE_DEPENDENT} for row in rows
            ]
        elif path.suffix in (".json", ".md", ".cff", ".txt", ".csv"):
            found[name] = path.read_bytes()
        else:  # pictures hold the time of day
            found[name] = path.stat().st_size > 0
    return found


def words_of(name: str, folders: Folders) -> list[str]:
    """The command of a name."""
    commands = {
        "run": RUN,
        "run --sweep": SWEEP,
        "study run": ["study", "run", str(folders.inputs / "study.toml"), "--jobs", "1"],
        "vectors generate": ["vectors", "generate", "--vectors", str(folders.inputs / "vectors")],
        "demo": DEMO,
    }
    return [*commands[name], "--out", str(folders.out)]


def inputs(folder: Path) -> None:
    """A short study, and vectors of a few cases."""
    (folder / "study.toml").write_text(STUDY)
    few = folder / "vectors"
    shutil.copytree(vectors_folder(), few, ignore=shutil.ignore_patterns("expected", "manifest*"))
    for path in (few / "inputs").glob("*.json"):
        record = json.loads(path.read_text())
        record["cases"] = record["cases"][:CASES]
        path.write_text(json.dumps(record))


def kill_outcome(name: str, folders: Folders, longest: float, rng: random.Random, two: bool) -> str:
    """What one folder came to after a kill: columns of the page, and what was lost."""
    words = words_of(name, folders)
    output = folders.out.with_suffix(".txt")
    by = signal.SIGINT if rng.random() < 0.25 else signal.SIGKILL
    child = child_of(words, output)
    others = []
    if two:
        others = [child_of(words, folders.out.with_suffix(".second"))]
    time.sleep(rng.uniform(0.0, longest))
    with suppress(ProcessLookupError):
        os.kill(child, by)
    status = exit_status(child)
    said = ["ended before" if status == 0 else "killed" if by == signal.SIGKILL else "interrupted"]
    for other in others:
        said += ["second ones refused"] if exit_status(other) == 2 else []
    more = []
    for _ in range(MOST):
        status = exit_status(child_of([*words, *more], output))
        if status == 0:
            return ", ".join(said + (["resumed"] if more else []))
        message = output.read_text()
        if status not in (2, 130) or "Traceback" in message:
            return f"lost: status {status}, {message[-300:]!r}"
        more = ["--resume"] if "--resume" in message and not more else more
    return f"lost: {MOST} commands do not end, {output.read_text()[-300:]!r}"


def of_command(name: str, count: int, seed: int, folder: Path) -> Iterator[Counter[str]]:
    """What is added to the row of a command by each of its folders, which lie in one of its own."""
    inputs_of = folder / "inputs"
    folder = folder / name
    folder.mkdir()
    with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere):
        command([*words_of(name, Folders(folder / "imported", inputs_of)), "--quiet"])
    threads = len(os.listdir("/proc/self/task"))
    assert threads == 1, f"{threads} threads, of which a copy would have one"
    left_alone = Folders(folder / "alone", inputs_of)
    status = exit_status(child_of(words_of(name, left_alone), folder / "alone.txt"))
    assert status == 0, (folder / "alone.txt").read_text()
    begun = time.monotonic()
    exit_status(
        child_of(words_of(name, Folders(folder / "timed", inputs_of)), folder / "timed.txt")
    )
    longest = time.monotonic() - begun
    right = digest(left_alone.out)
    for i in range(seed, seed + count):
        folders = Folders(folder / f"{name}{i}", inputs_of)
        said = kill_outcome(name, folders, longest, random.Random(i), i % 10 == 0)
        if not said.startswith("lost"):
            left = digest(folders.out)
            if left != right:
                differ = [k for k in {*left, *right} if left.get(k) != right.get(k)]
                said = f"lost: {sorted(differ)[:5]} differ, of {name} {i}"
        if said.startswith("lost"):
            print(f"{name} {i}: {said}", file=sys.stderr, flush=True)
        yield Counter(["lost"] if said.startswith("lost") else said.split(", "))
        shutil.rmtree(folders.out, ignore_errors=True)


def main() -> int:
    """Kill all; exit status 1 if something was lost."""
    tqdm.monitor_interval = 0  # which is a thread
    tqdm.set_lock(RLock())  # its own is shared by copies: one that is killed would hold it for ever
    names = ("run", "run --sweep", "study run", "vectors generate", "demo")
    options = script_options(__doc__, count=500, only="", out=Path)
    rows = {
        name: Counter(dict(zip(COLUMNS, map(int, cells), strict=True)))
        for name, cells in rows_before(options.out).items()
    }
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "inputs").mkdir()
        inputs(Path(folder) / "inputs")
        for name in names if not options.only else (options.only,):
            row = rows.setdefault(name, Counter())
            seed = row["killed"] + row["interrupted"] + row["ended before"]
            for folders in of_command(name, options.count, seed, Path(folder)):
                row.update(folders)
                if options.out:  # what is known if this is killed, too
                    text_written(options.out, page_of(rows))
    show_page(page_of(rows), options.out)
    return int(any(row["lost"] for row in rows.values()))


def page_of(rows: dict[str, Counter[str]]) -> str:
    """The page."""
    lines = [
        f"| {name} | {' | '.join(str(row[kind]) for kind in COLUMNS)} |"
        for name, row in rows.items()
    ]
    columns = " | ".join(COLUMNS)
    return PAGE.format(
        columns=columns, lines="|".join("---" for _ in COLUMNS), rows="\n".join(lines)
    )


if __name__ == "__main__":
    sys.exit(main())
