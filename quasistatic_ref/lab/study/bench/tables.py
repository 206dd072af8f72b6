"""All tables of the benchmark, each from its own module."""

import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.measures import slope
from quasistatic_ref.lab.study.bench.acceptance import from_paper, promises
from quasistatic_ref.lab.study.bench.clouds import clouds
from quasistatic_ref.lab.study.bench.grasp import (
    by_compiled_code,
    certification,
    interfaces,
    parts,
    places,
    residual_over_off,
)
from quasistatic_ref.lab.study.bench.large import (
    CHAINS,
    CONTACTS,
    FEW,
    HEAP_STEPS,
    PILES,
    ROW,
    SHORT,
    LargeStep,
    large_step,
)
from quasistatic_ref.lab.study.bench.mujoco_grasp import mujoco_grasp
from quasistatic_ref.lab.study.bench.push import pushes, slopes
from quasistatic_ref.lab.study.measuring import environment
from quasistatic_ref.solve.backends import installed

Tell = Callable[[str], None]


def tables(quick: bool, tell: Tell) -> dict[str, Any]:
    """Measure everything; `quick` measures a little of everything, to see that it runs.

    Parameters
    ----------
    quick : bool
    tell : callable
        Called with the name of each table before it is measured.

    Raises
    ------
    InputError
        If DAQP, which the comparison is with, is not installed.
    """
    if "daqp" not in installed("native"):
        raise InputError("compares the step with DAQP: pip install daqp", field="bench")
    steps, repeat = (6, 1) if quick else (250, 2)
    found: dict[str, Any] = {"quick": quick, "machine": machine()}
    load = f"load before the run {_load()}"
    at = places(steps)
    tell("interfaces")
    found["interfaces"] = interfaces(at, repeat)
    tell("compiled")
    found["compiled"] = by_compiled_code(at, repeat)
    tell("parts")
    some = places(4 if quick else 60)
    found["parts"] = parts(some, 1 if quick else 2)
    tell("certification")
    found["certification"] = certification(some, 1 if quick else 2)
    found["residual_over_off"] = residual_over_off(some, 1 if quick else 2)
    tell("mujoco")
    found["mujoco"] = mujoco_grasp(steps, repeat)
    tell("push")
    found["push"] = pushes(6 if quick else 60, repeat)
    found["slopes"] = slopes(3 if quick else 60, repeat)
    tell("clouds")
    found["clouds"] = clouds(at, (2_000,) if quick else (1_000, 10_000, 100_000, 1_000_000))
    tell("sizes")
    rows = [large_step((n, 1, 1)) for n in ((2, 4) if quick else (1, 5, *CHAINS))]
    counts = [] if quick else [large_step((ROW, 1, 1), k) for k in CONTACTS]
    few = [large_step((SHORT, 1, 1), k) for k in (FEW[:2] if quick else FEW)]
    heaps = [large_step((2, 1, 2))] if quick else [large_step(s, steps=HEAP_STEPS) for s in PILES]
    for name, sizes in (("chains", rows), ("contacts", [*few, *counts]), ("heaps", heaps)):
        found[name] = [asdict(size) for size in sizes]
    found["exponents"] = {
        "bodies": _fitted([row for row in rows if row.bodies >= CHAINS[0]], "bodies"),
        "contacts": _fitted(counts, "contacts"),
    }
    found["machine"]["load"] = f"{load}, after it {_load()}"
    found["promises"], found["times_paper"] = promises(found), from_paper(found)
    return found


def machine() -> dict[str, Any]:
    """What was measured on, and what was measured."""
    return {"quasistatic_ref": __version__, "numpy": np.__version__, **environment.machine()}


def _load() -> str:
    """How many processes wanted to run in the last minute, where the system says so."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def _fitted(steps: Sequence[LargeStep], over: str) -> float | None:
    """Exponent of time over bodies or contacts; None with fewer than two sizes."""
    if len(steps) < 2:
        return None
    return slope([getattr(step, over) for step in steps], [step.seconds for step in steps])
