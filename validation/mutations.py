"""Mutants of the paper's page, the judge, contacts and coordinates: which the tests notice.

Run ``python -m validation.mutations`` (about half an hour on two cores; name files of the package
to try only theirs, or ``--sample 100``). Each mutant is put into a temporary copy of the package,
and the tests of its file, a fast selection, are run on it: killed, or survived. Survivors are
listed in validation/mutation_survivors.md with a reason each; the exit status is 1 if one has none.
The tests run a fixed sample of the mutants, all of which they must kill.
"""

from __future__ import annotations

import argparse
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
FOLLOWED = ("properties/test_tracker.py",)


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
    "solve/native.py": ("unit/test_native.py",),
    "step/blocks.py": ("unit/test_sparse.py",),
    "step/sparse_form.py": ("unit/test_sparse.py",),
}
"""The files that are mutated, and the tests that are to notice, the quickest first."""

# Slow, and asks nothing of the package.
LEFT_OUT = f"tests/{EXACT[-1]}::test_the_family_holds_every_kind_of_problem"
SECONDS = {"own": 8, "others": 25}
"""Seconds of processor time after which a mutant hangs, and has been noticed: the tests of its own
file take two, the others eight."""

RUN = """
import contextlib, resource, sys
seconds, *arguments = sys.argv[1:]
with contextlib.suppress(ValueError, OSError):  # a mutant may loop, and gather memory
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
import pytest
sys.exit(pytest.main(arguments))
"""


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
        for k in range(self.workers):
            folder = Path(self._temporary.name) / str(k)
            for part in ("quasistatic_ref", "tests", "validation"):
                # Compiled files come along: those of unchanged sources hold.
                shutil.copytree(ROOT / part, folder / part)
            shutil.copy(ROOT / "pyproject.toml", folder)
            self._free.put(folder)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
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

    @staticmethod
    def _tried(folder: Path, tests: Iterable[str], seconds: int) -> str:
        chosen = [f"tests/{test}" for test in tests]
        options = ["-x", "-q", "-p", "no:cacheprovider", "--deselect", LEFT_OUT]
        environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
        environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "CI": "1"}
        done = subprocess.run(
            [sys.executable, "-c", RUN, str(seconds), *options, *chosen],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode in (0, 1):
            return "killed" if done.returncode else "survived"
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "hangs"
        if done.returncode == 2 or done.returncode < 0:  # while collecting; by a signal
            return "broken"
        raise RuntimeError(f"pytest itself failed:\n{done.stdout}{done.stderr}")


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
    options = parser.parse_args()
    chosen = all_mutants(options.files)
    if options.sample is not None:
        chosen = random.Random(1).sample(chosen, min(options.sample, len(chosen)))
    counts: Counter[str] = Counter()
    survivors: list[Mutant] = []
    with Workbench() as bench:
        for mutant, said in tqdm(bench.outcomes(chosen), total=len(chosen)):
            counts[said] += 1
            if said == "survived":
                survivors.append(mutant)
                tqdm.write(f"line {mutant.line}: {mutant.key}", file=sys.stderr)
    known = reasons()
    print(f"{len(chosen)} mutants: {', '.join(f'{n} {said}' for said, n in counts.items())}")
    unexplained = [m.key for m in survivors if m.key not in known]
    for key in unexplained:
        print(f"- `{key}`: ")
    if unexplained:
        print(f"{len(unexplained)} survivors without a reason in {SURVIVORS.name}")
    return int(bool(unexplained))


if __name__ == "__main__":
    sys.exit(main())
