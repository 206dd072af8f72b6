"""C or numba for compiled code, in numbers: ``python -m validation.make.compilers --out FILE``.

Of C: the library of ``quasistatic_ref/optional/fast/compiled`` by each compiler that is here,
compiled into an empty cache, loaded by a new process, and the call of one function. Of numba: its
import, one function of
twenty lines (the inverse of a matrix) compiled and, from its cache, loaded by a new process, and
the call of a function that is given 40 arrays, about as many as a step has. What each takes on the
disk is what its packages list. Takes a minute; needs numba and ziglang.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from importlib.metadata import distribution
from pathlib import Path

from quasistatic_ref.formats.files import text_written

ROOT = Path(__file__).parents[2]

OF_C = """
import time
from quasistatic_ref.step import arrays
start = time.perf_counter()
from quasistatic_ref.optional.fast.compiled.library import library
found = library()
loaded = time.perf_counter() - start
import ctypes
block = ctypes.create_string_buffer(4096)
address = ctypes.addressof(block)
def called():
    start = time.perf_counter()
    for _ in range(10_000): found.positions(address)
    return (time.perf_counter() - start) / 10_000
print([loaded, min(called() for _ in range(10))])
"""

OF_NUMBA = """
import time
import numpy as np
start = time.perf_counter()
from numba import njit
imported = time.perf_counter() - start
from inverse import inverse
inverse(np.eye(3), np.eye(3))
loaded = time.perf_counter() - start
names = ", ".join(f"a{i}" for i in range(40))
made = {}
exec(f"def first({names}): return a0[0]", made)
first, arrays = njit(made["first"]), [np.zeros(3)] * 40
first(*arrays)
def called():
    start = time.perf_counter()
    for _ in range(10_000): first(*arrays)
    return (time.perf_counter() - start) / 10_000
print([loaded, min(called() for _ in range(10))])
"""

INVERSE = '''
from numba import njit

@njit(cache=True)
def inverse(K, R):
    """The inverse of a square matrix by Gauss and Jordan."""
    n, a = K.shape[0], K.copy()
    for c in range(n):
        p = c
        for i in range(c + 1, n):
            if abs(a[i, c]) > abs(a[p, c]):
                p = i
        for j in range(n):
            a[p, j], a[c, j] = a[c, j], a[p, j]
            R[p, j], R[c, j] = R[c, j], R[p, j]
        d = 1 / a[c, c]
        for j in range(n):
            a[c, j] *= d
            R[c, j] *= d
        for i in range(n):
            if i != c:
                f = a[i, c]
                for j in range(n):
                    a[i, j] -= f * a[c, j]
                    R[i, j] -= f * R[c, j]
'''


def megabytes(*packages: str) -> float:
    """What packages take on the disk, bytecode left out [MB]."""
    files = [file for name in packages for file in distribution(name).files or ()]
    kept = [Path(str(file.locate())) for file in files if file.suffix != ".pyc"]
    return sum(path.stat().st_size for path in kept if path.is_file()) / 1e6


def timed(source: str, folder: str, **settings: str) -> tuple[float, float, float]:
    """Seconds to the first result with an empty cache and with a full one, and of one call."""
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}:{folder}", **settings}
    command = [sys.executable, "-c", source]
    runs = [
        json.loads(subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout)
        for _ in range(4)
    ]  # fmt: skip
    return runs[0][0], min(run[0] for run in runs[1:]), min(run[1] for run in runs)


def main() -> None:
    """Measure, print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the table here, too")
    options = parser.parse_args()
    zig = f"{sys.executable} -m ziglang cc"
    rows = []
    for name, compiler, size in (("C, cc", "cc", 0.0), ("C, ziglang", zig, megabytes("ziglang"))):
        with tempfile.TemporaryDirectory() as cache:
            settings = {"QUASISTATIC_REF_CC": compiler, "XDG_CACHE_HOME": cache}
            rows.append((name, size, *timed(OF_C, cache, **settings)))
    with tempfile.TemporaryDirectory() as cache:
        (Path(cache) / "inverse.py").write_text(INVERSE, "utf-8")
        rows.append(("numba", megabytes("numba", "llvmlite"), *timed(OF_NUMBA, cache)))
    lines = [
        "# C or numba",
        "",
        "Written by `python -m validation.make.compilers`, whose text says what is measured.",
        "",
        "| code | packages [MB] | first use [s] | later, a new process [ms] | a call [us] |",
        "|---|---|---|---|---|",
        *(
            f"| {name} | {size:.0f} | {first:.1f} | {1e3 * later:.0f} | {1e6 * call:.1f} |"
            for name, size, first, later, call in rows
        ),
    ]
    print(text := "\n".join(lines) + "\n")
    if options.out is not None:
        text_written(options.out, text)


if __name__ == "__main__":
    main()
