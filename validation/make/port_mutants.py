"""Mistakes in programs that the checker's rules were not written with, and what it says of each.

Run ``python -m validation.make.port_mutants --out FILE`` (hours; name a port for it alone). Every
formula of the ports in ``validation/ports``, which were written from the README of the vectors, is
changed mechanically, one place at a time (``port_changes``). Of the changed programs those are
kept, ``--each`` of each port at most, that answer another number in a committed or random case.
Each of these is

- checked with the committed vectors, as ``vectors check`` does, and
- challenged, as ``vectors challenge`` does by default: 1,000 cases from seed 0, until something is
  found. What is found is named in the same way; its case is not made smaller, which changes no
  name. Where it has no name, a challenge asks the committed cases, and says of them what a check
  says.

Half of the mutants, by a hash of their names, is kept apart: no rule is written while looking at
them, and the page counts them only. The records (``--records``, by default those that are
committed) have what is known of each, and a second run goes on from there; ``--each 0`` prints the
page of what they hold, ``--cases N`` sends fewer.

Exit status 1 if a right port is found wrong, or a mutant not at all.
"""

import ast
import hashlib
import json
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.challenge.fresh import EASY, HARD, PLAIN, fresh_case
from quasistatic_ref.lab.vectors.challenge.rounds import ROUND
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.compare import leaves
from quasistatic_ref.lab.vectors.check.folder import answer_judged
from quasistatic_ref.lab.vectors.check.freedoms import aligned
from quasistatic_ref.lab.vectors.check.likeness import likely, wrong_parts
from quasistatic_ref.lab.vectors.check.mistakes import Failed, mistakes_of
from quasistatic_ref.lab.vectors.check.patched import text_of_file
from quasistatic_ref.lab.vectors.check.scope import scope_read
from quasistatic_ref.lab.vectors.check.table import PATCHES
from quasistatic_ref.lab.vectors.check.verdict import FAILED, MISSING, Verdict
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import Case
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.make.fingerprints import subjects
from validation.make.port_changes import Change, changes, switched_line
from validation.tools.port_programs import (
    ENVIRONMENT,
    Program,
    Question,
    committed_questions,
    replies,
)
from validation.tools.ports import PORTS, compiler_errors, texts
from validation.tools.scripts import RESULTS, script_options, show_page

RECORDS = RESULTS / "port_mutants.jsonl"
CASES = 1000
"""Of a challenge by default."""
MORE = 12
"""Further cases of a layer in which something fails, by which a challenge names it."""
EACH = 150
"""Mutants of each port."""
OTHER = 1e-6
"""A number is another one from here on, relative to the largest of its field [-]."""
SWITCH = """#include <cstdlib>
inline const int MUTANT = std::getenv("MUTANT") ? std::atoi(std::getenv("MUTANT")) : 0;
"""
"""Which mutant the program in C++ is, which is compiled once with all of them."""


@dataclass
class Found:
    """What one way of looking says of a mutant.

    Parameters
    ----------
    layer : str
        The first that fails.
    names : list of str
        Of the mistakes that are named there.
    kind : str
        ``wrong``, ``error`` or ``hang``; empty if nothing is found.
    formulas : list of str
        Where nothing is named, what the formulas compute that are said.
    """

    layer: str = ""
    names: list[str] = field(default_factory=list)
    kind: str = ""
    formulas: list[str] = field(default_factory=list)


@dataclass
class Trial:
    """What became of a mutant.

    Parameters
    ----------
    name, kind : str
    where : str
        The function, and the line that was changed.
    apart : bool
        Whether it is of the half that no rule is written for.
    outcome : str
        ``other`` if it answers another number, else ``same`` or ``no program``.
    check, challenge : Found
    """

    name: str
    kind: str
    where: str
    apart: bool
    outcome: str = "same"
    check: Found = field(default_factory=Found)
    challenge: Found = field(default_factory=Found)


@dataclass
class Seen:
    """What cases came to: whether an answer is another, what fails, is right, has no answer."""

    other: bool = False
    failed: dict[str, list[Failed]] = field(default_factory=dict)
    right: dict[str, list[Failed]] = field(default_factory=dict)
    silent: dict[str, list[Failed]] = field(default_factory=dict)
    trouble: str = ""

    def add(self, more: "Seen") -> None:
        """What further cases came to."""
        self.other = self.other or more.other
        self.trouble = self.trouble or more.trouble
        kinds = ("failed", "right", "silent")
        for mine, theirs in ((getattr(self, kind), getattr(more, kind)) for kind in kinds):
            for layer, ones in theirs.items():
                mine.setdefault(layer, []).extend(ones)

    @property
    def first_found(self) -> Found:
        """What is found, and named: in the first layer that fails."""
        for layer in LAYERS:
            failed = self.failed.get(layer, [])
            if failed or layer in self.silent:
                with np.errstate(all="ignore"):  # answers may be any numbers
                    named = mistakes_of(layer, failed, self.right.get(layer, []))
                return Found(layer, [one.name for one in named], self.trouble or "wrong")
        return Found(kind=self.trouble)

    @property
    def formulas(self) -> list[str]:
        """What the formulas compute in which a mistake would spoil nearly the same."""
        wrong: set[str] = set()
        for layer in LAYERS:
            for one in (*self.failed.get(layer, []), *self.silent.get(layer, [])):
                wrong |= {*wrong_parts(layer, one)}
        sides = (self.failed, self.right, self.silent)
        judged = {one.id for side in sides for ones in side.values() for one in ones}
        return [one.subject for one in likely(wrong, judged)]


class Port:
    """A port and its right answers.

    Parameters
    ----------
    name : str
    work : Path
        A folder for programs.
    """

    def __init__(self, name: str, work: Path) -> None:
        self.name = name
        self.scope = scope_read(PORTS / name / "scope.toml")
        self._work = work
        self._right: dict[str, str] = {}
        self._judged: dict[str, Failed] = {}
        self.false_alarms: list[str] = []
        self.program = Program(work / name)
        if said := compiler_errors(name, self.program.path):
            raise SystemExit(said)

    def within(self, questions: Sequence[Question]) -> list[Question]:
        """Those that are of its scope."""
        return [q for q in questions if self.scope.holds(q.layer, q.case, q.record)]

    def mutants(
        self, most: int, wanted: Callable[[Change], bool]
    ) -> Iterator[tuple[Change, Program | None]]:
        """Changes that are wanted, with their programs; None for one that does not compile."""
        if self.name == "cpp":
            yield from (one for one in list(self._switched_programs(most)) if wanted(one[0]))
            return
        for change in filter(wanted, changes(PORTS / self.name)):
            lines = texts(self.name)[change.file].splitlines(keepends=True)
            lines[change.line] = change.new
            path = self._work / "mutant"
            said = compiler_errors(self.name, path, {change.file: "".join(lines)})
            yield change, None if said else Program(path)

    def _switched_programs(self, most: int) -> Iterator[tuple[Change, Program]]:
        """One program with many mutants, one a line; of what does not compile there is none."""
        left: dict[tuple[str, int], tuple[int, Change, str]] = {}
        for number, change in enumerate(changes(PORTS / self.name), 1):
            text = switched_line(change, number)
            if text is not None and len(left) < most:
                left.setdefault((change.file, change.line), (number, change, text))
        path = self._work / "switched"
        while True:
            lines = {file: text.splitlines() for file, text in texts(self.name).items()}
            for (file, line), (_, _, text) in left.items():
                lines[file][line] = text
            changed = {file: "\n".join(text) + "\n" for file, text in lines.items()}
            changed["main.cpp"] = SWITCH + changed["main.cpp"]
            said = compiler_errors(self.name, path, changed)
            if not said:
                break
            places = re.findall(r"(\w+\.hpp):(\d+)[:,]", said)
            wrong = {(file, int(line) - 1) for file, line in places} & left.keys()
            if not wrong:
                raise SystemExit(said)
            for key in wrong:
                del left[key]
        for number, change, _ in left.values():
            yield change, Program(path, {**ENVIRONMENT, "MUTANT": str(number)})

    def look(self, program: Program, questions: Sequence[Question]) -> Seen:
        """Ask a program, and judge what it answers otherwise than the port does."""
        self._know(questions)
        given = replies(program, questions)
        seen = Seen()
        for q in questions:
            if q.id not in given:
                continue
            if given[q.id] == self._right[q.id]:
                seen.right.setdefault(q.layer, []).append(self._judged[q.id])
            elif '"output"' not in given[q.id]:
                seen.other, seen.trouble = True, "error" if given[q.id] else "hang"
                none = Failed(q.id, q.case, q.record, None, Verdict(q.id, MISSING))
                seen.silent.setdefault(q.layer, []).append(none)
            else:
                seen.other = seen.other or differs(q, self._right[q.id], given[q.id])
                one = self.judged(q, given[q.id])
                side = seen.failed if one.verdict.verdict == FAILED else seen.right
                side.setdefault(q.layer, []).append(one)
        return seen

    def _know(self, questions: Sequence[Question]) -> None:
        new = [q for q in questions if q.id not in self._right]
        self._right |= replies(self.program, new)
        for q in new:
            self._judged[q.id] = self.judged(q, self._right[q.id])
            if self._judged[q.id].verdict.verdict == FAILED:
                self.false_alarms.append(f"{q.id}: {self._judged[q.id].verdict.reason}")

    @np.errstate(all="ignore")
    def judged(self, q: Question, line: str) -> Failed:
        """A line that answers a question, as ``vectors check`` judges it."""
        case = Case(q.id, "", q.case)
        output = json.loads(line)["output"]
        return answer_judged(q.layer, case, q.record, output, Answers(), None, self.scope)


@cache
def question(layer: str, seed: tuple[int, ...], level: int) -> Question:
    """A case of a challenge."""
    case, record = fresh_case(layer, seed, level)
    return Question("/".join(("live", layer, *map(str, seed))), layer, case, record)


@cache
def challenge_round(number: int, layers: tuple[str, ...]) -> list[Question]:
    """The cases of one round of a challenge from seed 0."""
    level = (EASY, PLAIN, HARD)[min(number, 2) if number < 3 else 1 + number % 2]
    return [question(name, (0, number, i), level) for name in layers for i in range(ROUND[name])]


def differs(q: Question, one: str, other: str) -> bool:
    """Whether an answer has another number in a field that has one right value.

    A quaternion and its opposite are one.
    """
    a, b = (json.loads(text)["output"] for text in (one, other))
    flags = q.record["flags"]
    free = [] if flags.get("unique_multipliers", True) else ["lam", "wrench"]
    free += [] if flags.get("unique", True) else ["alpha", "beta", "n"]
    if a.keys() != b.keys():
        return True
    with suppress(TypeError, ValueError, IndexError):  # what is of another shape is another
        b = aligned(q.layer, q.case, a, b)
    for name in a.keys() - {*free, "farkas"}:
        mine, theirs = dict(leaves(a[name])), dict(leaves(b[name]))
        if mine.keys() != theirs.keys():
            return True
        size = max((abs(v) for v in mine.values() if isinstance(v, int | float)), default=0.0)
        for path, value in mine.items():
            given = theirs[path]
            numbers = isinstance(value, int | float) and isinstance(given, int | float)
            if not abs(value - given) <= OTHER * size if numbers else value != given:  # nan, too
                return True
    return False


def trial_of(port: Port, change: Change, program: Program | None, cases: int = CASES) -> Trial:
    """Check and challenge a mutant."""
    where = f"{change.place}: {change.old.strip()}"
    trial = Trial(change.name, change.kind, where, kept_apart(change.name))
    if program is None:
        trial.outcome = "no program"
        return trial
    checked = Seen()
    for layer in port.scope.layers:
        checked.add(port.look(program, port.within(committed_questions(layer))))
    trial.check = checked.first_found
    formulas = checked.formulas
    trial.check.formulas = [] if trial.check.names else formulas
    seen, sent, number = Seen(), 0, 0
    while sent < cases and not seen.failed and not seen.trouble:
        here = challenge_round(number, port.scope.layers)
        sent += len(port.within(here))
        new = port.look(program, port.within(here))
        seen.add(new)
        again = [
            question(name, (0, number, len(here), i), (PLAIN, HARD)[i % 2])
            for name in new.failed
            for i in range(MORE)
        ]
        seen.add(port.look(program, port.within(again)))
        number += 1
    trial.challenge = seen.first_found
    if trial.challenge.kind and not trial.challenge.names:
        trial.challenge.formulas = formulas
    if checked.other or seen.other:
        trial.outcome = "other"
    return trial


def part_of(name: str, parts: int) -> int:
    """Which part of the mutants one is of, by a hash of its name: from 0 to ``parts`` - 1."""
    return hashlib.sha256(name.encode()).digest()[0] % parts


def kept_apart(name: str) -> bool:
    """Whether a mutant is of the half that no rule is written for."""
    return part_of(name, 2) == 1


HEAD = """# Mistakes in programs that the checker's rules were not written with

Made by `python -m validation.make.port_mutants`: each formula of [the ports in Go and
C++](../ports/README.md) can be changed by a program, one place at a time. Each changed program that
answers another number is checked with the committed vectors, and challenged with the 1,000 cases
that a challenge has by default, until something is found. Said is a classic mistake in the first
layer that fails; where none is recognised, a check says in which one or two formulas a planted
mistake spoils nearly the same cases and fields (`quasistatic_ref/lab/vectors/check/likeness.py`),
and a challenge asks the committed cases for it. *Right*: the place that was changed computes one of
the things that are said, of 30 (`validation/ports/subjects.toml`); a classic mistake says those of
the lines in which the plain program would make it. *Wrong*: it does not. *Silent*: nothing is said.
Half of the mutants, by a hash of their names, is kept apart: no rule of the checker is written
while looking at them, and they are counted only. The table of subjects was written before any
mutant was tried; two lines of it, and the likeness below which nothing is said, were corrected by
the open half. A program that ends early or hangs is started again for the next case, as in a
challenge, until it has done so three times in a layer.
"""
VERDICTS = ("right", "wrong", "silent")
WAYS = ("check", "challenge")


@cache
def subjects_of_mistake(name: str) -> set[str]:
    """What the lines compute in which the plain program would make a classic mistake."""
    found: set[str] = set()
    for patch in {one for patches in PATCHES.get(name, {}).values() for one in patches}:
        functions: dict[str, str] = {}
        for line in patch.splitlines():
            sign, _, text = line.partition(" ")
            if sign == "-" and text in functions:
                found |= {*subjects("program", functions[text], text)}
            elif sign.endswith(":"):
                functions = function_by_line(sign.removesuffix(":"))
    return found


@cache
def function_by_line(file: str) -> dict[str, str]:
    """In which function of a file of the plain program each of its lines stands."""
    text = text_of_file(file)
    rows = [row.strip() for row in text.splitlines()]
    functions = [one for one in ast.parse(text).body if isinstance(one, ast.FunctionDef)]
    return {row: one.name for one in functions for row in rows[one.lineno : one.end_lineno]}


def verdict(one: Json, way: str) -> str:
    """What a way of looking says of a mutant: ``not found``, or one of VERDICTS."""
    said = one[way]
    if not said["kind"]:
        return "not found"
    named = {*said["formulas"]}.union(*map(subjects_of_mistake, said["names"]))
    if not named:
        return "silent"
    port = one["name"].partition(" ")[0]
    function, _, line = one["where"].partition(": ")
    return "wrong" if named.isdisjoint(subjects(port, function, line)) else "right"


def _row(label: str, ones: Sequence[Json]) -> tuple[object, ...]:
    cells: list[object] = [label, len(ones)]
    for way in WAYS:
        count = Counter(verdict(one, way) for one in ones)
        cells += [len(ones) - count["not found"], *(count[name] for name in VERDICTS)]
    return tuple(cells)


def page(trials: Sequence[Json]) -> Iterator[str]:
    """Both halves by kind and port; of the open one, what was not found or named wrong."""
    yield HEAD
    kept = [one for one in trials if one["outcome"] == "other"]
    every = sum(1 for name in ("go", "cpp") for _ in changes(PORTS / name))
    count = Counter(one["outcome"] for one in trials)
    yield f"Of {every:,} changes {len(trials)} were tried, of each kind one in turn: {len(kept)}"
    yield f"answer another number, {count['same']} do not, {count['no program']} are no program."
    by_name = sum(1 for one in kept if one["check"]["names"])
    two = sum(1 for one in kept if len(one["check"]["formulas"]) == 2)
    yield f"A check names {by_name} by a classic mistake, and says two formulas of {two}."
    yield ""
    ways = [f"{way}: {name}" for way in WAYS for name in ("found", *VERDICTS)]
    for title, apart in (("The half that is open", False), ("The half that is kept apart", True)):
        half = [one for one in kept if one["apart"] == apart]
        kinds = sorted({one["kind"] for one in half})
        rows = [_row(kind, [one for one in half if one["kind"] == kind]) for kind in kinds]
        for name, label in (("go", "all in Go"), ("cpp", "all in C++"), ("", "all")):
            rows.append(_row(label, [one for one in half if one["name"].startswith(name)]))
        yield f"## {title}"
        yield ""
        yield from markdown_table(("kind", "mutants", *ways), rows)
        yield ""
    for wanted in ("not found", "wrong"):
        yield f"## Open, and {wanted}"
        yield ""
        for one in kept:
            seen = [way for way in WAYS if verdict(one, way) == wanted]
            if seen and not one["apart"]:
                yield f"- {' and '.join(seen)}: `{one['name']}`"
        yield ""


def main() -> int:
    """Try mutants, and print the page."""
    options = script_options(
        __doc__, ("go", "cpp"), out=Path, records=RECORDS, each=EACH, cases=CASES
    )
    done: dict[str, Json] = {}
    if options.records.exists():
        lines = options.records.read_text("utf-8").splitlines()
        done = {one["name"]: one for one in map(json.loads, lines)}
    alarms: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for name in (options.names or ("go", "cpp")) if options.each else ():
            port = Port(name, Path(folder))
            kept = 0
            for change, program in port.mutants(2 * options.each, lambda change: True):
                if change.name not in done:
                    done[change.name] = asdict(trial_of(port, change, program, options.cases))
                    with options.records.open("a") as file:
                        file.write(json.dumps(done[change.name]) + "\n")
                kept += done[change.name]["outcome"] == "other"
                if kept >= options.each:
                    break
            alarms += port.false_alarms
    show_page("\n".join(page(list(done.values()))), options.out)
    for alarm in alarms:
        print(f"a right port is found wrong: {alarm}", file=sys.stderr)
    others = [one for one in done.values() if one["outcome"] == "other"]
    lost = [one for one in others if not any(one[way]["kind"] for way in WAYS)]
    return int(bool(alarms or lost))


if __name__ == "__main__":
    sys.exit(main())
