"""Large steps by backend, dense and sparse: ``python -m validation.make.large_steps --out FILE``.

Processor time, so that other programs hardly matter; two minutes. From it follow the numbers of
entries from which steps are sparse (``SPARSE_FROM`` and others in tolerances.py), and which backend
takes the large steps of a run that names none. Exit status 1 if a promise does not hold.
"""

import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

from quasistatic_ref import StepNotSolved
from quasistatic_ref.lab.machine import machine
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.lab.thresholds import slope
from quasistatic_ref.optional.fast import simulator as fast
from validation.tools.scripts import script_options, show_page

Shape = tuple[int, int, int]
ROWS = tuple((n, 1, 1) for n in (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48))
HEAPS = ((2, 2, 2), (3, 3, 3), (4, 4, 3))
LARGEST = (5, 5, 4)
WAYS = {
    "daqp dense": 48, "piqp dense": 24, "piqp sparse": 1000, "clarabel dense": 8,
    "clarabel sparse": 1000, "osqp dense": 8, "osqp sparse": 8,
}  # fmt: skip
"""Backends, and up to how many bodies each is tried: beyond, it takes a multiple of the others."""
CHAINS = (10, 20, 40, 80, 160)
"""Bodies in a row."""
STEPS = 12
MANY = 100
HEAP_LIMIT = 60.0
"""Of the largest heap, nothing certified [ms]."""
EXPONENT_LIMIT = 1.15


@dataclass(frozen=True)
class Cost:
    """Some steps of one scene.

    Parameters
    ----------
    size : tuple of int
        Bodies, contacts, coordinates, rows.
    milliseconds : ndarray
        Of processor time, of each step after the first [ms].
    bounds : list of float
        Of the error, where known.
    unsolved : int
        Steps for which the backend had no answer; Clarabel's was taken.
    """

    size: tuple[int, int, int, int]
    milliseconds: np.ndarray
    bounds: list[float]
    unsolved: int

    @property
    def median(self) -> float:
        """Of all steps [ms]."""
        return float(np.median(self.milliseconds))

    @property
    def first(self) -> float:
        """The median of the third to the seventh step [ms]."""
        return float(np.median(self.milliseconds[1:6]))

    @property
    def tail(self) -> float:
        """The 99th percentile [ms]."""
        return float(np.quantile(self.milliseconds, 0.99))


def cost(shape: Shape, way: str, steps: int = STEPS, k: int = 4, certify: str = "off") -> Cost:
    """What steps of boxes that are pulled over a floor cost."""
    backend, form = way.split()
    with patch.object(fast, "sparse_from", lambda *_: int(form == "sparse")):
        some = pile(shape, k, backend=backend, certify=certify)
    other = pile(shape, k, backend="clarabel", certify=certify)
    simulator = some.simulator
    q = some.q
    times = []
    bounds = []
    unsolved = 0
    for _ in range(1 + steps):
        begin = time.process_time()
        try:
            result = simulator.step(q, np.zeros(0), some.force)
        except StepNotSolved:
            unsolved += 1
            result = other.simulator.step(q, np.zeros(0), some.force)
        times.append(1e3 * (time.process_time() - begin))
        bound = result.solution.certificate.error_bound
        bounds += [] if bound is None else [bound]
        q = result.q
    size = some.bodies, some.contacts, result.step.n_v, int(result.step.offsets[-1])
    return Cost(size, np.array(times[1:]), bounds, unsolved)


def name(shape: Shape) -> str:
    """Bodies in a row, or along each axis."""
    return str(shape[0]) if shape[1:] == (1, 1) else " x ".join(map(str, shape))


def promises(measured: Iterable[tuple[str, float, float]]) -> tuple[list[str], bool]:
    """The table of what is promised, measured and its limit; whether all of it holds."""
    rows = []
    for promise, value, limit in measured:
        verdict = "holds" if value <= limit else "FAILS"
        rows.append((promise, f"{value:.3g}", f"{limit:g}", verdict))
    table = markdown_table(("promise", "measured", "at most", "verdict"), rows)
    return table, all(row[3] == "holds" for row in rows)


def by_way() -> list[str]:
    """The table of medians of every way at every size."""
    rows = []
    for shape in (*ROWS, *HEAPS):
        found = []
        entries = 0
        for way, most in WAYS.items():
            if np.prod(shape) > most:
                found.append("-")
                continue
            some = cost(shape, way)
            entries = 4 * some.size[1] * some.size[2]
            lost = f" ({some.unsolved} unsolved)" if some.unsolved else ""
            found.append(f"{some.median:.2f}{lost}")
        rows.append([name(shape), f"{entries:,}", *found])
    return markdown_table(("boxes", "entries of J", *WAYS), rows)


def large_table() -> tuple[list[str], dict[str, float], float]:
    """The table of sparse steps, the exponents in bodies, and the largest heap's first [ms]."""
    head = "boxes, backend, contacts, coordinates, rows, first [ms], off [ms], off p99 [ms], "
    head += "residual [ms], residual p99 [ms], largest error bound, without bound, unsolved"
    rows = []
    times = {}
    heap = 0.0
    for shape in (*((n, 1, 1) for n in CHAINS), LARGEST):
        for backend in ("piqp", "clarabel"):
            steps = MANY if shape == LARGEST else 2 * STEPS
            off = cost(shape, f"{backend} sparse", steps)
            said = cost(shape, f"{backend} sparse", steps, certify="residual")
            milliseconds = (off.first, off.median, off.tail, said.median, said.tail)
            rows.append([name(shape), backend, *(f"{n:,}" for n in off.size[1:])])
            rows[-1] += [f"{ms:.1f}" for ms in milliseconds] + [f"{max(said.bounds):.1e}"]
            without = 1 + len(said.milliseconds) - len(said.bounds)
            rows[-1] += [str(without), str(off.unsolved + said.unsolved)]
            times.setdefault(backend, []).append(off.median)
            heap = off.first if backend == "piqp" else heap
    table = markdown_table(head.split(", "), rows)
    return table, {b: slope(CHAINS, t[:-1]) for b, t in times.items()}, heap


def in_contacts() -> dict[str, float]:
    """The exponents in contacts of a row of 16 boxes."""
    counts = (2, 4, 8, 16, 32)
    found = {}
    for backend in ("piqp", "clarabel"):
        some = [cost((16, 1, 1), f"{backend} sparse", k=k) for k in counts]
        found[backend] = slope([s.size[1] for s in some], [s.median for s in some])
    return found


def main() -> int:
    """Measure, and write the page."""
    options = script_options(__doc__, out=Path)
    m = machine()
    words = (
        f"Written by `python -m validation.make.large_steps` on {m['processor']}, {m['cores']} "
        f"cores, Python {m['python']}: processor time, medians of {STEPS} steps or more after the "
        "first, natively, accuracy 1e-12, no row compiled. Boxes are pulled over a floor, four "
        "contacts a pair. The first are the third to the seventh step: as a "
        "heap spreads, its steps take more iterations."
    )
    dense = by_way()
    sparse, bodies, heap = large_table()
    measured = [(f"heap of {name(LARGEST)}, first [ms]", heap, HEAP_LIMIT)]
    for what, found in (("bodies", bodies), ("contacts", in_contacts())):
        measured += [(f"exponent in {what}, {b}", v, EXPONENT_LIMIT) for b, v in found.items()]
    table, kept = promises(measured)
    lines = [
        "# Large steps, by backend", "", words,
        "", "## Dense and sparse, nothing certified [ms]", "", *dense,
        "", "## Sparse steps", "", *sparse,
        "", "## Promises", "", *table,
    ]  # fmt: skip
    show_page("\n".join(lines), options.out)
    return int(not kept)


if __name__ == "__main__":
    sys.exit(main())
