"""Whether memory goes on growing while certified steps are taken.

Run ``python -m validation.make.memory_of_steps`` (a quarter to half an hour; ``--steps`` or Ctrl-C
makes it shorter). ``sphere_spin`` under a torque about the normal that is drawn at random at every
step, so that no step is like another: 50,000 steps with ``certify = full``, nothing of them kept.
What Python has allocated is traced, after a collection of garbage; what C libraries hold is seen in
the resident size. What a run keeps of its steps is a test's: ``tests/simulate/test_memory.py``.

Prints the page that is kept in ``validation/results/memory_of_steps.md``. Exit status 1 if in the
second half of the steps more was added than ``ENDS`` allows.
"""

from __future__ import annotations

import argparse
import gc
import sys
import tracemalloc
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np

from quasistatic_ref.scenario.scenario import load_scenario

ENDS = 0.5
"""Bytes a step, in the second half, below which growth counts as ended: caches that fill meet a
new entry of 50 bytes now and then; a list or a dictionary that grew with the steps would take 8."""
TORQUE = 0.147
"""Largest torque [N m], that of the scenario."""


def growth(steps: int, marks: list[int]) -> Iterator[tuple[int, int, int]]:
    """Traced bytes and resident bytes after some of the steps, none of which is kept.

    Parameters
    ----------
    steps : int
    marks : list of int
        After how many steps to look.
    """
    scenario, draw = load_scenario("sphere_spin", fast=True), np.random.default_rng(1)
    simulator, q, force = scenario.simulator(), scenario.system.q_start, np.zeros(6)
    tracemalloc.start()
    for k in range(1, steps + 1):
        force[5] = TORQUE * draw.random()
        q = simulator.step(q, np.zeros(0), force).q
        if k in marks:
            gc.collect()
            yield k, tracemalloc.get_traced_memory()[0], resident()
    tracemalloc.stop()


def resident() -> int:
    """The resident size of this process [bytes]; 0 where there is no /proc."""
    status = Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.exists() else []
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmRSS")), 0)


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--steps", type=int, default=50_000)
    steps = parser.parse_args().steps
    shares = (0.002, 0.02, 0.06, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    marks = sorted({max(1, round(share * steps)) for share in shares})
    print("# Memory of certified steps\n")
    print("Made by `python -m validation.make.memory_of_steps`.\n")
    print("| steps | allocated by Python [kB] | resident [MB] |")
    print("|---|---|---|")
    traced = {}
    with suppress(KeyboardInterrupt):  # Ctrl-C: what was reached counts
        for k, held, whole in growth(steps, marks):
            traced[k] = held
            print(f"| {k:,} | {held / 1e3:.1f} | {whole / 1e6:.1f} |", flush=True)
    last = max(traced)
    half = min(k for k in traced if k >= last / 2)
    rate = (traced[last] - traced[half]) / max(last - half, 1)
    print(f"\nFrom step {half:,} to step {last:,}, {rate:.2f} bytes a step were added.")
    if last < steps:
        print(f"\nStopped before step {steps:,}.")
    return 0 if rate < ENDS else 1


if __name__ == "__main__":
    sys.exit(main())
