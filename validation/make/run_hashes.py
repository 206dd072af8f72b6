"""SHA-256 of q of every scenario's run, on code for several processors, and with several NumPys.

    python -m validation.make.run_hashes [--steps STEPS] [--python PYTHON] [--log FILE] [--out FILE]

Runs are taken in processes of their own: with the kernels of OpenBLAS for other processors
(``OPENBLAS_CORETYPE``), without the vector code of NumPy and of the C library
(``NPY_DISABLE_CPU_FEATURES``, ``GLIBC_TUNABLES``), and with the oldest NumPy that the package
supports, which pip fetches into a temporary folder. ``--python`` names another Python, for which
pip installs the package with the newest of all that it needs. With ``--log`` what each process says
is kept as it ends, and the same command goes on from there. Takes some five minutes. Exit status 1
if a hash differs.
"""

import hashlib
import os
import platform
import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.metadata import requires
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from tqdm import tqdm

from quasistatic_ref import load_scenario
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.log import Log, Record
from validation.tools.scripts import ROOT, environment, script_options, show_page

KERNELS = ("SkylakeX", "Haswell", "Nehalem")
"""Processors with AVX-512, with FMA, and with neither."""
OLD_C_LIBRARY = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable"}
WORDS = """SHA-256 of the bytes of q, shape (steps + 1, n_q), float64, little-endian, of each
scenario's run with its own settings, in which each answer is certified; x86-64 Linux. Kernels are
those of OpenBLAS; "no vector code": NumPy without its own, and the C library without FMA and AVX2.

Poses, the joints' columns and gravity are formed by pinocchio's compiled code, of cosines and sines
that are correctly rounded; pin and coal are of one version in all rows. Of what no scenario has
nothing is claimed: revolute joints that mimic or are mimicked (their sines are the C library's),
pairs of curved solids (coal and LAPACK), planes of meshes (Qhull), answers that are not certified
(those of a backend). Not run: ARM, macOS, Windows.
"""


class Environment(NamedTuple):
    """How a run is taken.

    Parameters
    ----------
    kernel : str
    vectors : bool
        Whether with vector code.
    fast : bool
    python : str
    numpy : str
        A folder of NumPy, or empty for the one that is installed.
    """

    kernel: str
    vectors: bool = True
    fast: bool = True
    python: str = sys.executable
    numpy: str = ""


def hashes(names: Sequence[str], steps: int | None, fast: bool) -> list[str]:
    """The versions of Python and NumPy, then each scenario's hash, in this process."""
    limit = [] if steps is None else [f"steps={steps}"]
    found = [platform.python_version(), np.__version__]
    for name in names:
        run = load_scenario(name, ["record=light", *limit], fast=fast).run(progress=False)
        found.append(hashlib.sha256(run["q"].tobytes()).hexdigest())
    return found


def hashes_in(where: Environment, names: Sequence[str], steps: int | None) -> list[str]:
    """The same in a process of its own."""
    settings = {"OPENBLAS_CORETYPE": where.kernel, "PYTHONPATH": where.numpy}
    if not where.vectors:
        vectors = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
        settings |= OLD_C_LIBRARY | {"NPY_DISABLE_CPU_FEATURES": " ".join(vectors)}
    source = f"from {__spec__.name} import *; print(*hashes({[*names]}, {steps}, {where.fast}))"
    command = [where.python, "-c", source]
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **settings}, text=True, stdout=subprocess.PIPE,
        check=True,
    )  # fmt: skip
    return done.stdout.split()


def oldest_numpy(folder: str) -> str:
    """The oldest NumPy that the package supports, fetched into a folder."""
    (floor,) = (re.search(r">=([\d.]+)", r) for r in requires("quasistatic-ref") or []
                if r.startswith("numpy"))  # fmt: skip
    assert floor is not None
    home = Path(folder) / "oldest"
    environment(home, "--no-deps", f"numpy=={floor[1]}")
    (target,) = home.glob("lib/python*/site-packages")
    return str(target)


def environments(python: str | None, folder: str) -> list[Environment]:
    """All in which the runs are taken."""
    every = [Environment(kernel) for kernel in KERNELS]
    every += [Environment("Nehalem", vectors=False), Environment("Haswell", fast=False)]
    others = [{"numpy": oldest_numpy(folder)}]
    if python is not None:
        newest = environment(Path(folder) / "newest", f"{ROOT}[robots]", python=python)
        others.append({"python": str(newest)})
    for other in others:
        every += [Environment(kernel, **other) for kernel in KERNELS]
        every.append(Environment("Nehalem", vectors=False, **other))
    return every


def report(steps: int | None, python: str | None, path: Path | None) -> tuple[str, bool]:
    """The committed result, and whether all hashes are equal; a log at `path`."""
    names = scenario_names()
    lines = []
    first = []
    equal = True
    log = Log(path, itemgetter("number"), {"steps": steps, "python": python})
    with tempfile.TemporaryDirectory() as folder:
        places = environments(python, folder)

        def run(number: int) -> Record:
            return {"number": number, "said": hashes_in(places[number], names, steps)}

        records = tqdm(log.records(range(len(places)), run), "processes", len(places))
        for where, record in zip(places, records, strict=True):
            version, numpy, *found = record["said"]
            first = first or found
            same = sum(a == b for a, b in zip(first, found, strict=True))
            equal &= same == len(names)
            kernel = where.kernel if where.vectors else f"{where.kernel}, no vector code"
            path = "fast" if where.fast else "plain"
            lines.append(f"| {version} | {numpy} | {kernel} | {path} | {same} of {len(names)} |")
    limit = "" if steps is None else f", the first {steps} steps"
    return "\n".join([
        "# Hashes of runs", "", WORDS, f"{' '.join(platform.libc_ver())}{limit}.", "",
        "| scenario | SHA-256 of q |", "|---|---|",
        *(f"| {name} | `{sha}` |" for name, sha in zip(names, first, strict=True)), "",
        "| Python | NumPy | kernel | path | as above |", "|---|---|---|---|---|", *lines,
    ]), equal  # fmt: skip


def main() -> int:
    """Write the result."""
    options = script_options(__doc__, steps=int, python=str, log=Path, out=Path)
    text, equal = report(options.steps, options.python, options.log)
    show_page(text, options.out)
    return int(not equal)


if __name__ == "__main__":
    sys.exit(main())
