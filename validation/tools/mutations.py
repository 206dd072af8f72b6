"""Mutants of the paper's page, the judge, contacts and coordinates: which the tests notice.

Run ``python -m validation.tools.mutations`` (an hour on two cores; name files of the package to try
only theirs, or ``--sample 100``). The tests of the files (validation/tools/mutating/mutated.py) are
collected once. Each mutant is then put into a fork of that process, and meets the tests that run
the function it changes: killed, or survived. Mutants of a constant are imported instead. Survivors
are listed in validation/results/mutation_survivors.md with a reason each; the exit status is 1 if
one has none. What came of each file stands in validation/results/mutations.md, with a hash of its
code: ``--stale`` tries the files that have changed since, or were never tried. The tests run a
fixed sample of the mutants, all of which they must kill.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from operator import itemgetter
from pathlib import Path

import pytest
from tqdm import tqdm

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.parallel import Log
from validation.tools.mutating.mutants import Mutant, mutants
from validation.tools.mutating.mutated import TESTS
from validation.tools.mutating.trials import Trials

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "quasistatic_ref"
SURVIVORS = ROOT / "validation" / "results" / "mutation_survivors.md"
RESULTS = ROOT / "validation" / "results" / "mutations.md"
KINDS = ("killed", "broken", "hangs", "survived")
HEAD = """# Mutants by file

Written by `python -m validation.tools.mutations`: of each file of the package the SHA-256 (its
first digits) of the code whose mutants were tried, how many there are, and what the tests say of
them. Files that have changed since, or are not here, are tried by `--stale`. Why the survivors
survive stands in `validation/results/mutation_survivors.md`.

| file | SHA-256 | mutants | killed | broken | hangs | survived |
|-|-|-|-|-|-|-|
"""


def all_mutants(files: Iterable[str] = TESTS) -> list[Mutant]:
    """Every mutant of some files of the package."""
    return [m for file in files for m in mutants(file, (PACKAGE / file).read_text())]


def outcomes(
    chosen: Iterable[Mutant],
    heard: Callable[[Mutant, str], None],
    traced: Path | None = None,
    tests: Mapping[str, tuple[str, ...]] = TESTS,
) -> None:
    """Try mutants on the tests of their files, and report each as soon as they have said something.

    They say ``"killed"``, ``"broken"`` (it cannot be imported, or crashes) or ``"hangs"``: all of
    these are noticed. Or ``"survived"``.

    Raises
    ------
    RuntimeError
        If the tests do not pass without a mutant.
    """
    mutants_now = list(chosen)
    files = {test for mutant in mutants_now for test in tests[mutant.file]}
    of_constants: list[Mutant] = []

    def one(mutant: Mutant, said: str | None) -> None:
        if said is None:
            of_constants.append(mutant)
        else:
            heard(mutant, said)

    trials = Trials(PACKAGE, mutants_now, tests, one, traced)
    paths = [str(ROOT / "tests" / file) for file in sorted(files)]
    options = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", f"--rootdir={ROOT}"]
    status = pytest.main([*options, *paths], plugins=[trials])
    if status not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        raise RuntimeError("the tests do not pass without a mutant")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = {pool.submit(imported, m, tests[m.file]): m for m in of_constants}
        for job in as_completed(jobs):
            heard(jobs[job], job.result())


def imported(mutant: Mutant, tests: Iterable[str]) -> str:
    """What tests say of a mutant that is there when the package is imported."""
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder) / "mutant.py"
        text.write_text(mutant.source)
        paths = [str(ROOT / "tests" / test) for test in tests]
        run = [
            sys.executable,
            "-m",
            "validation.tools.mutating.imported",
            str(PACKAGE / mutant.file),
        ]
        status = subprocess.run(
            [*run, str(text), *paths],
            cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, check=False,
        ).returncode  # fmt: skip
    if status in (0, 1):
        return "killed" if status else "survived"
    return "hangs" if status == -signal.SIGXCPU else "broken"


def reasons() -> dict[str, str]:
    """The reasons that are written down, by the key of the mutant."""
    if not SURVIVORS.exists():
        return {}
    return dict(re.findall(r"^- `(.+?)`: (.+)$", SURVIVORS.read_text(), re.MULTILINE))


def code_hash(file: str) -> str:
    """The first digits of the SHA-256 of a file's code, without comments and docstrings."""
    tree = ast.parse((PACKAGE / file).read_text())
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):  # of a lambda it is an expression
            node.body = [part for part in body if not _is_text(part)] or [ast.Pass()]
    return hashlib.sha256(ast.unparse(tree).encode()).hexdigest()[:12]


def _is_text(part: ast.stmt) -> bool:
    return isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant)


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
            rows[file] = (code_hash(file), str(len(said)), *counts)
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
    files = [f for f in options.files if known_rows.get(f, ("",))[0] != code_hash(f)]
    chosen = all_mutants(files)
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    log = Log(options.log, itemgetter("mutant"))
    left = [mutant for mutant in chosen if mutant.key not in log.found]
    progress = tqdm(desc="mutants", total=len(left))

    def heard(mutant: Mutant, said: str) -> None:
        log.add({"mutant": mutant.key, "said": said})
        progress.update()
        if said == "survived":
            tqdm.write(f"line {mutant.line}: {mutant.key}", file=sys.stderr)

    if left:
        outcomes(left, heard, options.log and options.log.with_suffix(".traces.json"))
    found = {key: one["said"] for key, one in log.found.items()}
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
