"""Mutants of the paper's page, the judge, contacts and coordinates: which the tests notice.

Run ``python -m validation.mutations`` (about half an hour on two cores; name files of the package
to try only theirs, or ``--sample 100``). Each mutant is put into a temporary copy of the package,
and the tests of its file, a fast selection, are run on it: killed, or survived. Survivors are
listed in validation/mutation_survivors.md with a reason each; the exit status is 1 if one has none.
The tests run a fixed sample of the mutants, all of which they must kill.
"""

from __future__ import annotations

import argparse
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
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from types import TracebackType

from tqdm import tqdm

from validation.mutants import Mutant, mutants

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "quasistatic_ref"
SURVIVORS = ROOT / "validation" / "mutation_survivors.md"
PAGE = (
    "equations/test_eq01_impedance.py",
    "equations/test_eq04_contact_rows.py",
    "equations/test_eq05_tangential_directions.py",
    "equations/test_eq06_opposite_tangents.py",
    "equations/test_eq07_torsional_directions.py",
    "equations/test_eq08_stacked_rows.py",
    "equations/test_eq13_step_problem.py",
)
JUDGE = (
    "equations/test_eq09_force_balance.py",
    "equations/test_eq10_primal_feasibility.py",
    "equations/test_eq11_dual_feasibility.py",
    "equations/test_eq12_complementarity.py",
)
EXACT = (
    "unit/test_exact.py",
    "unit/test_active_set.py",
    "unit/test_rational.py",
    "unit/test_rounding.py",
    "unit/test_certificate.py",
    "unit/test_farkas.py",
    "properties/test_exact_against_enumeration.py",
)

SYSTEM = ("unit/test_system.py", "unit/test_system_forces.py", "unit/test_system_refusals.py")
CONTACT = (
    "equations/test_eq02_relative_velocity.py",
    "equations/test_eq03_contact_jacobian.py",
)
FOLLOWED = ("unit/test_shortlist.py", "properties/test_tracker.py")
FORGED = ("unit/test_single_faults.py", "unit/test_enclosure.py", "properties/test_forgeries.py")
CURVED = ("unit/test_curved_pairs.py", "unit/test_distance.py")


def ordered(own: str) -> tuple[str, ...]:
    """The tests of the exact method, those of one unit first."""
    first = f"unit/test_{own}.py"
    return (first, *(test for test in EXACT if test != first))


TESTS: dict[str, tuple[str, ...]] = {
    "step/problem.py": ("unit/test_standard_form.py", *PAGE, "unit/test_problem.py"),
    "step/friction.py": ("unit/test_friction.py", *PAGE, "unit/test_cones.py"),
    "step/standard_form.py": ("unit/test_standard_form.py", *PAGE),
    "certify/optimality.py": ("unit/test_optimality.py", *JUDGE, "unit/test_enclosure.py"),
    "certify/dyadic.py": ordered("rational"),
    "certify/rational.py": ordered("rational"),
    "certify/kkt.py": ordered("exact"),
    "certify/dependence.py": ordered("dependence"),
    "certify/balls.py": ordered("exact"),
    "certify/point.py": ordered("exact"),
    "certify/active_set.py": ordered("active_set"),
    "certify/degeneracy.py": ordered("exact"),
    "certify/rounding.py": ordered("rounding"),
    "certify/exact.py": ordered("exact"),
    "certify/exact_step.py": ordered("farkas"),
    "certify/confirm.py": ("unit/test_confirm.py",),
    "certify/bound.py": ("unit/test_bound.py", *FORGED),
    "certify/rounded_bound.py": ("unit/test_rounded_bound.py",),
    "certify/gap.py": ("unit/test_gap.py", *FORGED),
    "certify/impulses.py": ("unit/test_impulses.py", *FORGED),
    "certify/judged.py": ("unit/test_judged.py", *FORGED),
    "certify/ellipsoid.py": FORGED,
    "certify/apex.py": FORGED,
    "certify/conic.py": FORGED,
    "certify/verdict.py": ("unit/test_certificate.py", *FORGED),
    "certify/warm.py": ("unit/test_warm.py", *EXACT),
    "certify/sensitivity.py": ("unit/test_sensitivity.py",),
    "certify/parameters.py": ("unit/test_sensitivity.py",),
    "certify/rows.py": ("unit/test_certificate.py", "unit/test_farkas.py"),
    "certify/farkas.py": ("unit/test_farkas.py",),
    "certify/certificate.py": ordered("certificate"),
    "certify/norm.py": ("unit/test_digits.py", "unit/test_farkas.py"),
    "certify/digits.py": ("unit/test_digits.py",),
    "model/coordinates.py": ("unit/test_system.py",),
    "model/rotation.py": ("unit/test_rotation.py",),
    "model/system.py": SYSTEM,
    "contact/jacobian.py": ("unit/test_jacobian.py", *CONTACT),
    "contact/cloud.py": ("unit/test_cloud.py",),
    "contact/pairs.py": ("unit/test_pairs.py", "unit/test_jacobian.py"),
    "contact/tracker.py": FOLLOWED,
    "contact/cloud_tracker.py": FOLLOWED,
    "contact/batch.py": FOLLOWED,
    "contact/shortlist.py": FOLLOWED,
    "contact/ball_tree.py": FOLLOWED,
    "contact/settle.py": CURVED,
    "contact/faces.py": CURVED,
    "contact/by_coal.py": CURVED,
    "contact/curved_pair.py": CURVED,
    "solve/native.py": ("unit/test_native.py",),
    "step/blocks.py": ("unit/test_sparse.py",),
    "step/sparse_form.py": ("unit/test_sparse.py",),
}
"""The files that are mutated, and the tests that are to notice, the quickest first."""

# Slow, and asks nothing of the package.
LEFT_OUT = f"tests/{EXACT[-1]}::test_the_family_holds_every_kind_of_problem"
SECONDS = {"own": 30, "others": 60}
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
        options = ["-x", "-q", "-p", "no:cacheprovider", "--deselect", LEFT_OUT]
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


def main() -> int:
    """Try mutants, and list the survivors."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="*", default=list(TESTS), help="certify/exact.py, ...")
    parser.add_argument("--sample", type=int, help="only so many, chosen at random, always alike")
    parser.add_argument("--log", type=Path, help="outcomes, from which the same command goes on")
    options = parser.parse_args()
    chosen = all_mutants(options.files)
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    log: Path | None = options.log
    lines = log.read_text().splitlines() if log is not None and log.exists() else []
    found = {key: said for said, key in (json.loads(line) for line in lines)}
    left = [mutant for mutant in chosen if mutant.key not in found]
    with Workbench() as bench:
        for file in sorted({mutant.file for mutant in left}):
            if bench.outcome(Mutant(file, file, 1, (PACKAGE / file).read_text())) != "survived":
                sys.exit(f"the tests of {file} fail without a mutant")
        for mutant, said in tqdm(bench.outcomes(left), total=len(left)):
            found[mutant.key] = said
            if log is not None:
                with log.open("a") as file:
                    print(json.dumps([said, mutant.key]), file=file)
            if said == "survived":
                tqdm.write(f"line {mutant.line}: {mutant.key}", file=sys.stderr)
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
