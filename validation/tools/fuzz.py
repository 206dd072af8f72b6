"""Every reader given spoilt files: ``python -m validation.tools.fuzz --inputs 100000``.

Inputs are good files with bytes, tokens, values or arrays changed, by a seed: the i-th input of a
reader is the same on every machine. They are read in a process with limits of memory and time,
which is started again when it ends. A file is accepted, or refused in one sentence of the exception
tree; a traceback, a crash, a hang (10 s of processor time) or more than 2 GiB are failures, whose
inputs are kept. ``outcomes.jsonl`` in the folder of ``--out`` has a line a batch: the same command
goes on from there. ``--seconds`` begins no batch after so long, 900 are a quarter of an hour;
``--table`` writes the table of what is in the folder. Exit status 1 if there was a failure.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from importlib import import_module
from operator import itemgetter
from pathlib import Path
from typing import Any

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.parallel import Log
from quasistatic_ref.lab.supervised import Supervised
from validation.tools.fuzzing.worker import ENDED, SECONDS, content_of

BATCH = 300
"""Inputs of one reader before those of the next."""
ROOT = Path(__file__).parents[2]
COLUMNS = ("reader", "inputs", "accepted", "refused", "failures", "longest [s]",
           "most memory [MiB]")  # fmt: skip
READERS = "validation.tools.fuzzing.readers"
Job = tuple[str, int, int]


def outcomes(
    jobs: Sequence[Job], readers: str = READERS, seconds: float = SECONDS
) -> Iterator[list[Any]]:
    """``[reader, i, outcome, seconds, MiB, words]`` of every input, whatever ends a process.

    Parameters
    ----------
    jobs : sequence of (str, int, int)
        Name of a reader, its first input, how many.
    readers : str
        Module whose function `readers` makes them.
    seconds : float
        Most processor time of one input [s].
    """
    left = [list(job) for job in jobs]
    variables = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    variables["PYTHONPATH"] = str(ROOT)
    while left:
        words = [sys.executable, "-m", "validation.tools.fuzzing.worker", json.dumps(left), readers,
                 str(seconds)]  # fmt: skip
        one = Supervised(words, subprocess.PIPE, variables, errors=subprocess.DEVNULL)
        with one.process as process:
            assert process.stdout is not None
            try:
                for line in process.stdout:
                    found = json.loads(line)
                    if "mistake" in found:
                        raise RuntimeError(found["mistake"])
                    yield found
                    _done(left)
                process.wait()
            finally:  # also where nobody waits for the rest
                one.end()
        if left and process.returncode:  # the input that was read then ended it
            name, i, _ = left[0]
            outcome = ENDED.get(-process.returncode, "crash")
            lasted = seconds if outcome == "hang" else 0.0
            yield [name, i, outcome, lasted, 0.0, f"status {process.returncode}"]
            _done(left)


def _done(left: list[list[Any]]) -> None:
    left[0][1:] = left[0][1] + 1, left[0][2] - 1
    if not left[0][2]:
        del left[0]


def batches(jobs: Sequence[Job], folder: Path, readers: str) -> Iterator[dict[str, Any]]:
    """What came of each job; inputs that failed are written to the folder."""
    records = {(name, start): _begun(name, start, count) for name, start, count in jobs}
    ends = {(name, start + count - 1): (name, start) for name, start, count in jobs}
    of = {(name, i): (name, start) for name, start, n in jobs for i in range(start, start + n)}
    for name, i, outcome, seconds, mebibytes, words in outcomes(jobs, readers):
        record = records[of[name, i]]
        record["seconds"] = round(max(record["seconds"], seconds), 3)
        record["mebibytes"] = round(max(record["mebibytes"], mebibytes))
        if outcome in ("accepted", "refused"):
            record[outcome] += 1
        else:
            record["failures"].append({"input": i, "outcome": outcome, "words": words})
        if (name, i) in ends:
            if record["failures"]:
                kept(readers, name, [failure["input"] for failure in record["failures"]], folder)
            yield record


def _begun(name: str, start: int, count: int) -> dict[str, Any]:
    said = {"reader": name, "start": start, "count": count, "accepted": 0, "refused": 0}
    return {**said, "seconds": 0.0, "mebibytes": 0.0, "failures": []}


def kept(readers: str, name: str, inputs: list[int], folder: Path) -> None:
    """Write inputs of a reader to a folder, for a person to look at and for a test."""
    with tempfile.TemporaryDirectory() as scratch:
        reader = import_module(readers).readers(Path(scratch))[name]
    for i in inputs:
        file = f"{name.replace('/', ' ')} {i}{Path(reader.file).suffix}"
        (folder / file).write_bytes(content_of(reader, i))


def table(records: list[dict[str, Any]]) -> list[str]:
    """Lines of the table, one a reader."""
    lines = []
    readers = sorted({record["reader"] for record in records})
    for name in [*readers, "all"]:
        own = [record for record in records if name in (record["reader"], "all")]
        sums = (sum(record[key] for record in own) for key in ("count", "accepted", "refused"))
        failures = sum(len(record["failures"]) for record in own)
        cells = [f"{n:,}" for n in (*sums, failures)]
        cells += [f"{max(r['seconds'] for r in own):.2f}", f"{max(r['mebibytes'] for r in own)}"]
        lines.append((name, *cells))
    return markdown_table(COLUMNS, lines, left=1)


def main() -> int:
    """Read batches until there are enough, then print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=100_000, help="in all")
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--readers", default=READERS, metavar="MODULE")
    parser.add_argument("--reader", action="append", metavar="NAME", help="may be repeated")
    parser.add_argument("--out", type=Path, default=Path("fuzz"), metavar="FOLDER")
    parser.add_argument("--table", type=Path, metavar="FILE.md")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    log = Log(options.out / "outcomes.jsonl", itemgetter("reader", "start"))
    module = import_module(options.readers)
    readers = options.reader or module.names()
    begun, each = time.monotonic(), -(-options.inputs // len(readers))
    jobs = [
        (name, start, min(BATCH, each - start))
        for start in range(0, each, BATCH) for name in readers if (name, start) not in log.found
    ]  # fmt: skip
    for number, record in enumerate(batches(jobs, options.out, options.readers), start=1):
        log.add(record)
        said = f"{record['accepted']} accepted, {record['refused']} refused"
        print(f"{number}/{len(jobs)} {record['reader']}: {said}", flush=True)
        for failure in record["failures"]:
            print(f"  {failure['outcome']} of input {failure['input']}: {failure['words']}")
        if time.monotonic() - begun > options.seconds:
            break
    records = list(log.found.values())
    if options.table:
        options.table.write_text(module.PAGE + "\n".join(table(records)) + "\n")
    print(*table(records), sep="\n")
    return 1 if any(record["failures"] for record in records) else 0


if __name__ == "__main__":
    sys.exit(main())
