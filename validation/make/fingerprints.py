"""Which committed cases the mistakes of one place in the plain program make wrong.

Run ``python -m validation.make.fingerprints --out FILE`` (a quarter of an hour); the file is
``quasistatic_ref/lab/vectors/check/fingerprints.json.gz``, by which ``vectors check`` says where
to look. The first ``--first`` changes of the program (``program_changes``) are made, one at a time.
What each makes wrong in the layers 1 to 8 is noted by case and field, where the program itself is
right. ``validation/ports/subjects.toml`` says what each line computes. ``--every N`` makes some
again, and compares them with the file: exit status 1 if one is less alike than ALIKE. Run it with
``OPENBLAS_NUM_THREADS=1``: threads that wait spend processor time, of which a case has CASE.
"""

import gzip
import json
import re
import signal
import sys
import time
import tomllib
import warnings
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.lab.vectors.check.likeness import wrong_fields
from quasistatic_ref.lab.vectors.check.patched import MODULES, Program, program_of, text_of_file
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.make.program_changes import Change, changes
from validation.tools.port_programs import Question, committed_questions
from validation.tools.ports import PORTS
from validation.tools.scripts import ROOT, script_options

SUBJECTS = PORTS / "subjects.toml"
FILE = ROOT / "quasistatic_ref/lab/vectors/check/fingerprints.json.gz"
FIRST = 1500
"""Changes that are made: some two of each line."""
CASE, ALL = 0.7, 12.0
"""Processor time after which a case has no answer, and no more are asked [s]."""

ALIKE = 0.5
"""Least share of what a mistake makes wrong here or in the file that is wrong in both [-]. It was
0.69 to 1 on another kernel of BLAS: last bits decide where a tolerance or a branch is spoiled."""


class Asked(NamedTuple):
    """A committed case, and what of the plain program's answer differs from what is expected."""

    question: Question
    own: set[str]


class Known(NamedTuple):
    """The cases, and by line or function those in which it runs."""

    cases: list[Asked]
    runs: dict[tuple[str, int | str], set[int]]


@cache
def known() -> Known:
    """Of the plain program as it is."""
    right = program_of({})
    questions = [q for layer in LAYERS if layer != "derivative" for q in committed_questions(layer)]
    runs: dict[tuple[str, int | str], set[int]] = defaultdict(set)
    cases = []
    before = sys.gettrace()
    for number, q in enumerate(questions):
        sys.settrace(_notes(runs, number))
        output = right(q.layer, q.case)
        sys.settrace(before)
        cases.append(Asked(q, wrong_fields(q.layer, q.case, q.record, output)))
    return Known(cases, runs)


def _notes(runs: dict[tuple[str, int | str], set[int]], number: int) -> Any:
    """A trace function by which each line and function of the program notes a case."""

    def note(frame: FrameType, event: str, _: Any) -> Any:
        code = frame.f_code
        if code.co_filename.removesuffix(".py") not in MODULES:
            return None
        runs[code.co_filename, code.co_name].add(number)
        runs[code.co_filename, frame.f_lineno].add(number)
        return note

    return note


def _end(*_: Any) -> None:
    raise TimeoutError


def spoiled(change: Change) -> set[str]:
    """What a change makes wrong: cases, and their fields, as ``wrong_parts`` names them."""
    program = program_of({change.file: change.text})
    runs = known().runs
    found: set[str] = set()
    began = time.process_time()
    before = signal.signal(signal.SIGPROF, _end)
    for i in sorted(runs[change.file, change.line] or runs[change.file, change.function]):
        if time.process_time() - began < ALL:
            found |= _spoiled(program, known().cases[i])
    signal.signal(signal.SIGPROF, before)
    return found


@np.errstate(all="ignore")
def _spoiled(program: Program, one: Asked) -> set[str]:
    q = one.question
    try:
        signal.setitimer(signal.ITIMER_PROF, CASE)
        output = program(q.layer, q.case)
        signal.setitimer(signal.ITIMER_PROF, 0)
        fields = wrong_fields(q.layer, q.case, q.record, output) - one.own
    except Exception:  # a changed program may fail in any way
        signal.setitimer(signal.ITIMER_PROF, 0)
        fields = {""}
    return {q.id, *(f"{q.id} {name}" for name in fields)} if fields else set()


@cache
def subject_table() -> dict[str, dict[str, list[str]]]:
    """By program, patterns of ``FUNCTION: LINE``, and what such lines compute."""
    return tomllib.loads(SUBJECTS.read_text("utf-8"))


def subjects(name: str, function: str, line: str) -> tuple[str, ...]:
    """What a line of a program computes.

    Parameters
    ----------
    name : str
        ``program``, or a port's.
    function, line : str
    """
    place = f"{function}: {line.strip()}"
    for pattern, found in subject_table()[name].items():
        if re.match(pattern, place):
            return tuple(found)
    raise KeyError(f"nothing is said of {place}")


def fingerprint(change: Change) -> tuple[tuple[str, ...], str, str]:
    """What is computed at a change, where, and the change."""
    line = text_of_file(change.file).splitlines()[change.line - 1]
    place = f"{change.function} in {change.file}"
    return (
        subjects("program", change.function, line), place,
        f"{change.line}: {change.old} -> {change.new}",
    )  # fmt: skip


def content(found: Sequence[tuple[Change, set[str]]]) -> bytes:
    """The file: of mistakes of one subject that make the same wrong, the first."""
    names = sorted(set().union(*(wrong for _, wrong in found)))
    bits = {name: 1 << i for i, name in enumerate(names)}
    mistakes, seen = [], set()
    for change, wrong in found:
        subject, place, text = fingerprint(change)
        number = f"{sum(bits[name] for name in wrong):x}"
        if wrong and (subject, number) not in seen:
            seen.add((subject, number))
            mistakes.append([subject, place, text, number])
    text = json.dumps({"wrong": names, "mistakes": mistakes}, indent=0)
    return gzip.compress(text.encode(), mtime=0)


def others(every: int) -> Iterator[str]:
    """Those of each so many mistakes of the file that are less alike than ALIKE today."""
    whole = json.loads(gzip.decompress(FILE.read_bytes()))
    made = {(place, text): change for change in changes()
            for _, place, text in [fingerprint(change)]}  # fmt: skip
    for _, place, text, number in whole["mistakes"][::every]:
        planted = {name for i, name in enumerate(whole["wrong"]) if int(number, 16) >> i & 1}
        change = made.get((place, text))
        wrong = set() if change is None else spoiled(change)
        if len(wrong & planted) < ALIKE * len(wrong | planted):
            yield f"{place}, {text}"


def main() -> int:
    """Make the file, or some of it again."""
    options = script_options(__doc__, out=Path, first=FIRST, every=0)
    warnings.simplefilter("ignore")
    if options.every:
        found = list(others(options.every))
        print(*(found or ["as in the file, or nearly"]), sep="\n")
        return int(bool(found))
    made = []
    for number, change in zip(range(options.first), changes(), strict=False):
        made.append((change, spoiled(change)))
        if number % 100 == 0:
            print(number, time.strftime("%H:%M:%S"), file=sys.stderr, flush=True)
    (options.out or FILE).write_bytes(content(made))
    return 0


if __name__ == "__main__":
    sys.exit(main())
