"""All tables of the benchmark, each from its own module."""

from __future__ import annotations

import platform
from collections.abc import Callable
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.solve.native import native_backends
from quasistatic_ref.study.bench.acceptance import from_paper, promises
from quasistatic_ref.study.bench.clouds import clouds
from quasistatic_ref.study.bench.grasp import certification, parts, places, roads
from quasistatic_ref.study.bench.mujoco_grasp import mujoco_grasp
from quasistatic_ref.study.bench.sizes import fitted, sizes

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
    if "daqp" not in native_backends():
        raise InputError("the step is compared with DAQP; pip install daqp", field="bench")
    steps, repeat = (6, 1) if quick else (250, 2)
    found: dict[str, Any] = {"quick": quick, "machine": machine()}
    at = places(steps)
    tell("roads")
    found["roads"] = roads(at, repeat)
    tell("parts")
    some = places(4 if quick else 60)
    found["parts"] = parts(some, 1 if quick else 2)
    tell("certification")
    found["certification"] = certification(some, 1 if quick else 2)
    tell("mujoco")
    found["mujoco"] = mujoco_grasp(steps, repeat)
    tell("clouds")
    found["clouds"] = clouds(at, (2_000,) if quick else (1_000, 10_000, 100_000, 1_000_000))
    tell("sizes")
    grids = [(2, 1, 1), (4, 1, 1)] if quick else [(n, 1, 1) for n in (1, 2, 5, 10, 20, 50, 100)]
    found["chains"] = sizes(grids, 3 if quick else 15)
    per_pair = [] if quick else [1, 2, 5, 8]
    found["contacts"] = [row for k in per_pair for row in sizes([(50, 1, 1)], 10, k)]
    heaps = [(2, 1, 2)] if quick else [(3, 2, 2), (4, 3, 3), (5, 5, 4)]
    found["heaps"] = sizes(heaps, 2 if quick else 10)
    found["exponents"] = {
        "bodies": fitted(found["chains"], "bodies"),
        "contacts": fitted(found["contacts"], "contacts"),
    }
    found["promises"], found["times_paper"] = promises(found), from_paper(found)
    return found


def machine() -> dict[str, str]:
    """What was measured on."""
    return {
        "quasistatic_ref": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": f"{platform.system()} {platform.machine()}",
    }
