"""README's tests as other machines run them: kernels, orders, versions, Pythons.

    python -m validation.make.machines [NAME ...] [--out FILE]

Each row is one run of all tests with what README's line installs. Rows that are not named stay as
they are in FILE. An environment is made in a temporary folder for each Python and each choice of
versions; pip and the network are needed. A row takes two to twenty minutes on two cores. Exit
status 1 if a test fails.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from validation.tools.check_installs import LOWEST
from validation.tools.scripts import ROOT, environment, script_options, show_page

HEAD = """# README's tests, as other machines run them

Written by `python -m validation.make.machines --out validation/results/machines.md`. Each row is
one run of all tests, or of the core's, with what README's line installs. It varies several things
at once: where no test fails, none of them matters. *Core*: the tests in `analytic`, `certify`,
`contact`, `equations`, `model`, `shapes`, `simulate`, `solve` and `step` of `tests/`, a sample.
*Kernel*: that of OpenBLAS (`OPENBLAS_CORETYPE`). *No vector code*: NumPy without its own
(`NPY_DISABLE_CPU_FEATURES`). *Shuffled*: files, and tests within each, in a random order (the
plugin pytest-random-order). *Lowest*: of each package that `pyproject.toml` names the lowest
version, of others the newest. *No compiler*: `QUASISTATIC_REF_CC=none`. Python is 3.11 where none
is named. Skipped are the tests that need an extra, or a compiler. `.ci/run` has one more row:
README's line itself, with the newest versions, on the kernel SkylakeX where this page was made.
NumPy 2.5.2 to 2.5.5, which need Python 3.12, end in a segmentation fault with the kernels Haswell
and Zen where a matrix of 432 by 506 is multiplied by one of 506 by 200, without this package, too;
`pyproject.toml` leaves them out.

| run | Python | NumPy | passed | failed | skipped | minutes |
|---|---|---|---|---|---|---|
"""
COUNT = re.compile(r"(\d+) (passed|failed|skipped|error)")


class Machine(NamedTuple):
    """How the tests are run.

    Parameters
    ----------
    python : str
    lowest : bool
        Whether with the lowest versions that are declared.
    settings : mapping
        Variables of the environment.
    options : tuple of str
        Of pytest, among them what is tested where it is not all.
    """

    python: str = sys.executable
    lowest: bool = False
    settings: Mapping[str, str] = {}
    options: tuple[str, ...] = ()


def kernel(name: str) -> dict[str, str]:
    """The variable that chooses a kernel of OpenBLAS."""
    return {"OPENBLAS_CORETYPE": name}


CORE = tuple(
    f"tests/{name}"
    for name in ("analytic", "certify", "contact", "equations", "model", "shapes", "simulate",
                 "solve", "step")
)  # fmt: skip
"""A sample: what depends on floating-point numbers most."""
VECTORS = " ".join(np.show_config(mode="dicts")["SIMD Extensions"].get("found", []))
PLAIN = kernel("Prescott") | {"NPY_DISABLE_CPU_FEATURES": VECTORS}


def random_order_options(seed: int) -> tuple[str, ...]:
    """The options of pytest for a random order of files, and of the tests within each."""
    return ("--random-order", f"--random-order-seed={seed}")


MACHINES = {
    "lowest versions, kernel Zen": Machine(lowest=True, settings=kernel("Zen")),
    "Python 3.12, kernel Haswell, shuffled with seed 1": Machine(
        "python3.12", settings=kernel("Haswell"), options=random_order_options(1)
    ),
    "Python 3.13, kernel Prescott, no vector code, shuffled with seed 2": Machine(
        "python3.13", settings=PLAIN, options=random_order_options(2)
    ),
    "core, Python 3.14": Machine("python3.14", options=CORE),
}


def interpreter(machine: Machine, folder: Path) -> Path:
    """The interpreter of an environment with what README's line installs, made unless it is there.

    Raises
    ------
    FileNotFoundError
        If there is no such Python.
    subprocess.CalledProcessError
        If a package cannot be installed.
    """
    if shutil.which(machine.python) is None:
        raise FileNotFoundError(machine.python)
    home = folder / f"{Path(machine.python).name}{'-lowest' * machine.lowest}"
    if home.exists():
        return home / "bin" / "python"
    wanted = ["-e", f"{ROOT}[test]"]
    if not machine.lowest:
        return environment(home, *wanted, "pytest-random-order", python=machine.python)
    own = environment(home, python=machine.python)
    uv = environment(folder / "uv", "uv").with_name("uv")
    command = [uv, "pip", "install", "-q", "--compile-bytecode", "--python", own]
    subprocess.run([*command, *LOWEST, *wanted], check=True)
    return own


def row(name: str, folder: Path) -> tuple[str, bool]:
    """The line of the table of a run, and whether no test failed."""
    machine = MACHINES[name]
    try:
        python = interpreter(machine, folder)
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        said = "no such Python here" if isinstance(error, FileNotFoundError) else "not installable"
        return f"| {name} | {said} | | | | | |", True
    asks = "import platform, numpy; print(platform.python_version(), numpy.__version__)"
    versions = subprocess.check_output([python, "-c", asks], text=True).split()
    command = [python, "-m", "pytest", "-n", "2", "-q", "-p", "no:cacheprovider", *machine.options]
    start = time.perf_counter()
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **machine.settings}, text=True, stdout=subprocess.PIPE
    )
    minutes = (time.perf_counter() - start) / 60
    last = [line for line in done.stdout.splitlines() if COUNT.search(line)][-1:]
    found = {word: int(number) for number, word in COUNT.findall("".join(last))}
    failed = found.get("failed", 0) + found.get("error", 0)
    if done.returncode:
        print(done.stdout, file=sys.stderr)
    counts = (found.get("passed", 0), failed, found.get("skipped", 0))
    cells = [name, *versions, *map(str, counts), f"{minutes:.1f}"]
    return f"| {' | '.join(cells)} |", done.returncode == 0


def main() -> int:
    """Run what was named, or all; exit status 1 if a test failed."""
    options = script_options(__doc__, MACHINES, out=Path)
    rows = {}
    if options.out is not None and options.out.exists():
        lines = options.out.read_text("utf-8").splitlines()
        rows = {line.split(" | ")[0].removeprefix("| "): line for line in lines}
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or MACHINES:
            rows[name], passed = row(name, Path(folder))
            print(rows[name], file=sys.stderr, flush=True)
            good &= passed
    show_page(HEAD + "\n".join(rows[name] for name in MACHINES if name in rows), options.out)
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
