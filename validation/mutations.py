"""Mutants of the paper's page, the judge, contacts and coordinates: which the tests notice.

Run ``python -m validation.mutations`` (some hours on two cores; name files of the package to try
only theirs, or ``--sample 100``). Each mutant is put into a temporary copy of the package, and the
tests of its file, a fast selection, are run on it: killed, or survived. Survivors are listed in
validation/mutation_survivors.md with a reason each; the exit status is 1 if one has none. What came
of each file stands in validation/results/mutations.md, with the file's hash: ``--stale`` tries the
files that have changed since, or were never tried. The tests run a fixed sample of the mutants, all
of which they must kill.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType

from tqdm import tqdm

from quasistatic_ref.files import text_written
from validation.mutants import Mutant, mutants
from validation.mutated import EXACT, TESTS

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "quasistatic_ref"
SURVIVORS = ROOT / "validation" / "mutation_survivors.md"
RESULTS = ROOT / "validation" / "results" / "mutations.md"
KINDS = ("killed", "broken", "hangs", "survived")
HEAD = """# Mutants by file

Written by `python -m validation.mutations`: of each file of the package the SHA-256 (its first
digits) at which its mutants were tried, how many there are, and what the tests say of them. Files
that have changed since, or are not here, are tried by `--stale`. Why the survivors survive stands
in `validation/mutation_survivors.md`.

| file | SHA-256 | mutants | killed | broken | hangs | survived |
|-|-|-|-|-|-|-|
"""

# Slow, and asks nothing of the package.
LEFT_OUT = f"tests/{EXACT[-1]}::test_the_family_holds_every_kind_of_problem"
SECONDS = {"own": 20, "others": 40}
"""Seconds of processor time after which a mutant hangs, and has been noticed: the tests of its own
file take seven at most, the others fifteen."""

RUN = """
import contextlib, json, os, resource, sys
import coal, cvxpy, flint, pinocchio, pytest, scipy.optimize, scipy.spatial.transform
for line in sys.stdin:
    seconds, arguments = json.loads(line)
    child = os.fork()  # what is imported above takes longer than most tests
    if not child:
        said = os.open("said.txt", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(said, 1), os.dup2(said, 2)
        with contextlib.suppress(ValueError, OSError):  # a mutant may loop, and gather memory
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        try:
            os._exit(pytest.main(arguments))
        finally:
            os._exit(os.EX_SOFTWARE)  # an error of pytest's own
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""
"""Runs the tests of one mutant after the other, each in a process of its own."""


def all_mutants(files: Iterable[str] = TESTS) -> list[Mutant]:
    """Every mutant of some files of the package."""
    return [m for file in files for m in mutants(file, (PACKAGE / file).read_text())]


class Workbench:
    """Copies of the package and its tests, one for each worker, on which mutants are tried.

    Parameters
    ----------
    workers : int
    """

    def __init__(self, workers: int = 2) -> None:
        self.workers = workers

    def __enter__(self) -> Workbench:
        self._temporary = tempfile.TemporaryDirectory()
        self._free: SimpleQueue[Path] = SimpleQueue()
        self._runners: dict[Path, subprocess.Popen[str]] = {}
        for k in range(self.workers):
            folder = Path(self._temporary.name) / str(k)
            for part in ("quasistatic_ref", "tests", "validation"):
                # Compiled files come along: those of unchanged sources hold.
                shutil.copytree(ROOT / part, folder / part)
            for part in ("models", "docs"):  # read by tests, and not changed
                (folder / part).symlink_to(ROOT / part)
            shutil.copy(ROOT / "pyproject.toml", folder)
            environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
            environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "CI": "1"}
            self._runners[folder] = subprocess.Popen(
                [sys.executable, "-c", RUN], cwd=folder, env=environment, text=True,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            )  # fmt: skip
            self._free.put(folder)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        for runner in self._runners.values():
            runner.communicate()  # no more to run
        self._temporary.cleanup()

    def outcomes(self, chosen: Iterable[Mutant]) -> Iterator[tuple[Mutant, str]]:
        """Each mutant with what the tests say: as :meth:`outcome`."""
        with ThreadPoolExecutor(self.workers) as pool:
            tried = [(mutant, pool.submit(self.outcome, mutant)) for mutant in chosen]
            for mutant, result in tried:
                yield mutant, result.result()

    def outcome(self, mutant: Mutant) -> str:
        """What the tests say.

        ``"killed"``, ``"broken"`` (it cannot be imported, or crashes), ``"hangs"``; all of them
        are noticed. Or ``"survived"``.
        """
        folder = self._free.get()
        path = folder / "quasistatic_ref" / mutant.file
        kept = shutil.copy2(path, path.with_suffix(".kept"))
        try:
            path.write_text(mutant.source)
            first, *others = TESTS[mutant.file]
            # The file's own tests by themselves: to import the others takes longer than to run.
            said = self._tried(folder, [first], SECONDS["own"])
            if said != "survived" or not others:
                return said
            return self._tried(folder, others, SECONDS["others"])
        finally:
            os.replace(kept, path)  # not from the checkout, which may have changed meanwhile
            self._free.put(folder)

    def _tried(self, folder: Path, tests: Iterable[str], seconds: int) -> str:
        chosen = [f"tests/{test}" for test in tests]
        # What noticed the mutant before is run first: it may well notice this one.
        kept = f"cache_dir={folder}/{'own' if seconds == SECONDS['own'] else 'others'}.cache"
        options = ["-x", "-q", "--failed-first", "-o", kept, "--deselect", LEFT_OUT]
        runner = self._runners[folder]
        assert runner.stdin is not None
        assert runner.stdout is not None
        print(json.dumps([seconds, [*options, *chosen]]), file=runner.stdin, flush=True)
        status = int(runner.stdout.readline())
        if status in (0, 1):
            return "killed" if status else "survived"
        if status in (-signal.SIGXCPU, -signal.SIGKILL):
            return "hangs"
        if status == 2 or status < 0:  # while collecting; by a signal
            return "broken"
        raise RuntimeError(f"pytest itself failed:\n{(folder / 'said.txt').read_text()}")


def reasons() -> dict[str, str]:
    """The reasons that are written down, by the key of the mutant."""
    if not SURVIVORS.exists():
        return {}
    return dict(re.findall(r"^- `(.+?)`: (.+)$", SURVIVORS.read_text(), re.MULTILINE))


def source_hash(file: str) -> str:
    """The first digits of the SHA-256 of a file of the package."""
    return hashlib.sha256((PACKAGE / file).read_bytes()).hexdigest()[:12]


def tried_files() -> dict[str, tuple[str, ...]]:
    """What stands in the table of results: by file its hash, then how many mutants came to what."""
    if not RESULTS.exists():
        return {}
    rows = [row.strip("| ").split(" | ") for row in RESULTS.read_text().splitlines()]
    return {row[0].strip("`"): tuple(row[1:]) for row in rows if row[0].startswith("`")}


def table_written(found: Mapping[str, str]) -> None:
    """Enter each file all of whose mutants were tried into the table of results."""
    rows = tried_files()
    for file in TESTS:
        said = [found.get(mutant.key) for mutant in all_mutants([file])]
        if None not in said:
            counts = (str(said.count(kind)) for kind in KINDS)
            rows[file] = (source_hash(file), str(len(said)), *counts)
    lines = [f"| `{file}` | {' | '.join(rows[file])} |" for file in TESTS if file in rows]
    text_written(RESULTS, HEAD + "\n".join(lines) + "\n")


def main() -> int:
    """Try mutants, and list the survivors."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="*", default=list(TESTS), help="certify/exact.py, ...")
    parser.add_argument("--sample", type=int, help="only so many, chosen at random, always alike")
    parser.add_argument("--stale", action="store_true", help="only files that the table has not")
    parser.add_argument("--log", type=Path, help="outcomes, from which the same command goes on")
    options = parser.parse_args()
    known_rows = tried_files() if options.stale else {}
    files = [f for f in options.files if known_rows.get(f, ("",))[0] != source_hash(f)]
    chosen = all_mutants(files)
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    log: Path | None = options.log
    lines = log.read_text().splitlines() if log is not None and log.exists() else []
    found = {key: said for said, key in (json.loads(line) for line in lines)}
    left = [mutant for mutant in chosen if mutant.key not in found]
    with Workbench() as bench:
        by_tests = {TESTS[mutant.file]: mutant.file for mutant in left}
        as_it_is = [Mutant(f, f, 1, (PACKAGE / f).read_text()) for f in by_tests.values()]
        failing = [mutant.file for mutant, said in bench.outcomes(as_it_is) if said != "survived"]
        if failing:
            sys.exit(f"the tests of {', '.join(failing)} fail without a mutant")
        for mutant, said in tqdm(bench.outcomes(left), total=len(left)):
            found[mutant.key] = said
            if log is not None:
                with log.open("a") as file:
                    print(json.dumps([said, mutant.key]), file=file)
            if said == "survived":
                tqdm.write(f"line {mutant.line}: {mutant.key}", file=sys.stderr)
    table_written(found)
    known, counts = reasons(), Counter(found[mutant.key] for mutant in chosen)
    print(f"{len(chosen)} mutants: {', '.join(f'{n} {said}' for said, n in counts.items())}")
    survivors = [mutant for mutant in chosen if found[mutant.key] == "survived"]
    unexplained = [m.key for m in survivors if m.key not in known]
    for key in unexplained:
        print(f"- `{key}`: ")
    if unexplained:
        print(f"{len(unexplained)} survivors without a reason in {SURVIVORS.name}")
    return int(bool(unexplained))


if __name__ == "__main__":
    sys.exit(main())
