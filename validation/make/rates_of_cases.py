"""How many cases with exact answers `vectors challenge` can make in a second, on two cores.

Run ``python -m validation.make.rates_of_cases`` on a quiet machine (about two minutes; ``--jobs 1``
for one core). The inputs are the committed vectors', in turn, each answered as a challenge does it:
exactly, with its condition and tolerance. Prints one line for each promise; exit status 1 if one is
missed. Nothing is written: rates are those of a machine.
"""

from __future__ import annotations

import argparse
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from quasistatic_ref.formats.resources import vectors_folder
from quasistatic_ref.lab.vectors.challenge.terms import terms
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import layer as layer_of
from quasistatic_ref.lab.vectors.layers import step as step_layer

PROMISES = {"rows": 150.0, "steps up to two contacts": 60.0, "steps, all": 8.0}
"""Cases a second on two quiet cores."""
SECONDS = 20.0
"""That each is measured for, at least one pass over all of its cases."""


def inputs() -> dict[str, tuple[str, list[Json]]]:
    """Layer and inputs of each promise."""
    folder = vectors_folder()
    rows = [case.input for case in inputs_read(folder, "rows")]
    expected = expected_read(folder, "step")
    steps = [(len(expected[c.id]["output"]["contacts"]), c.input)
             for c in inputs_read(folder, "step")]  # fmt: skip
    few = [case for contacts, case in steps if contacts <= 2]
    return {
        "rows": ("rows", rows),
        "steps up to two contacts": ("step", few),
        "steps, all": ("step", [case for _, case in steps]),
    }


def answered(task: tuple[str, Json]) -> None:
    """Compute one case's answer, its condition and so its tolerance, as a challenge does."""
    name, case = task
    found = step_layer.expected(case, terms) if name == "step" else layer_of(name).expected(case)
    found.json()


def rate(pool: ProcessPoolExecutor, layer: str, cases: list[Json], seconds: float) -> float:
    """Cases a second: whole passes over all of them, until the time is over."""
    list(pool.map(answered, [(layer, cases[0])] * 8))  # imports, once in each process
    tasks = [(layer, case) for case in cases] * -(-100 // len(cases))
    done, began = 0, time.monotonic()
    while done == 0 or time.monotonic() - began < seconds:
        done += len(list(pool.map(answered, tasks)))
    return done / (time.monotonic() - began)


def main() -> int:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--jobs", type=int, default=2, help="processes (2)")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="for each (20)")
    given = parser.parse_args()
    missed = 0
    with ProcessPoolExecutor(given.jobs, mp_context=get_context("spawn")) as pool:
        for name, (layer, cases) in inputs().items():
            found = rate(pool, layer, cases, given.seconds)
            missed += found < PROMISES[name]
            words = "as promised" if found >= PROMISES[name] else "missed"
            print(f"{name}: {found:.1f}/s of {PROMISES[name]:g}/s promised on two cores, {words} "
                  f"({len(cases)} cases, {given.jobs} processes)", flush=True)  # fmt: skip
    return int(missed > 0)


if __name__ == "__main__":
    raise SystemExit(main())
