"""Mutants of the paper's page, the judge, contacts and coordinates: which the tests notice.

Run ``python -m validation.tools.mutations`` (some hours on two cores; name files of the package to
try only theirs, or ``--sample 100``). Each mutant is imported in a fork, and meets the tests of its
file (validation/tools/mutating/mutated.py): killed, or survived. Survivors are listed in
validation/results/mutation_survivors.md with a reason each; the exit status is 1 if one has none.
What came of each file stands in validation/results/mutations.md, with a hash of its code:
``--stale`` tries the files that have changed since, or were never tried. The tests run a fixed
sample of the mutants, all of which they must kill.
"""

import ast
import hashlib
import os
import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import itemgetter
from pathlib import Path

from tqdm import tqdm

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.log import Log
from quasistatic_ref.lab.parallel import results, workers
from validation.tools.mutating.mutants import Mutant, mutants
from validation.tools.mutating.mutated import TESTS
from validation.tools.mutating.tried import PACKAGE, ROOT, said_of
from validation.tools.scripts import script_options

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


def tests_of(mutant: Mutant) -> tuple[str, ...]:
    """The tests that are to notice a mutant."""
    return TESTS[mutant.file]


def outcomes(
    chosen: Iterable[Mutant],
    tests: Callable[[Mutant], tuple[str, ...]] = tests_of,
    jobs: int | None = None,
) -> Iterator[tuple[str, str]]:
    """The key of each mutant with what its tests say: see :func:`said_of`."""
    tasks = [(m.key, m.file, m.source, tests(m)) for m in chosen]
    with workers(jobs) as pool:
        yield from results(pool, jobs or os.cpu_count() or 1, outcome, tasks)


def outcome(key: str, file: str, source: str, tests: tuple[str, ...]) -> tuple[str, str]:
    """The key of a mutant, and what tests say of it."""
    return key, said_of(file, source, tests)


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


def table_written(files: Iterable[str], found: Mapping[str, str]) -> None:
    """Enter each of some files, if all of its mutants were tried, into the table of results."""
    rows = tried_files()
    for file in files:
        said = [found.get(mutant.key) for mutant in all_mutants([file])]
        if None not in said:
            counts = (str(said.count(kind)) for kind in KINDS)
            rows[file] = (code_hash(file), str(len(said)), *counts)
    lines = [f"| `{file}` | {' | '.join(rows[file])} |" for file in TESTS if file in rows]
    text_written(RESULTS, HEAD + "\n".join(lines) + "\n")


def main() -> int:
    """Try mutants, and list the survivors."""
    options = script_options(__doc__, TESTS, sample=int, stale=False, log=Path)
    known_rows = tried_files() if options.stale else {}
    files = [f for f in options.names or TESTS if known_rows.get(f, ("",))[0] != code_hash(f)]
    chosen = all_mutants(files)
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    log = Log(options.log, itemgetter("mutant"))
    left = [mutant for mutant in chosen if mutant.key not in log.found]
    if left:
        file = left[0].file
        every = {test for mutant in left for test in TESTS[mutant.file]}
        if said_of(file, (PACKAGE / file).read_text(), sorted(every)) != "survived":
            raise RuntimeError("the tests do not pass without a mutant")
    for key, said in tqdm(outcomes(left), "mutants", len(left)):
        log.add({"mutant": key, "said": said})
        if said == "survived":
            tqdm.write(key, file=sys.stderr)
    found = {key: one["said"] for key, one in log.found.items()}
    table_written(files, found)  # a log may hold others, tried before their tests changed
    known = reasons()
    counts = Counter(found[mutant.key] for mutant in chosen)
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
