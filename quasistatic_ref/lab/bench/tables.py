"""All tables of the benchmark, each from its own module."""

import os
from collections.abc import Callable
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab import machine as computer
from quasistatic_ref.lab.bench.acceptance import promises
from quasistatic_ref.lab.bench.derived import of_derivatives
from quasistatic_ref.lab.bench.grasp import (
    GraspSteps,
    certification,
    places,
)
from quasistatic_ref.lab.bench.solids import LARGE, SCENES, solid_scenes
from quasistatic_ref.lab.bench.whole_run import whole_run
from quasistatic_ref.optional.fast.speed import usable
from quasistatic_ref.solve.backends import installed

Tell = Callable[[str], None]

REPEAT = 12
"""How often the steps that promises speak of are taken. On a machine whose pace varies by half from
minute to minute, ratios of least times of 12 stay within 5 % of each other, of 2 within 20 %."""

RUNS = 5
"""Runs of a scene, each from its start, so that they have the same steps."""

SOLID_STEPS = 60
"""Steps of a run of a scene of solids."""
LARGE_STEPS = 10
"""The same of a scene with many bodies."""


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
        If DAQP, which the comparison is with, is not installed, or there is no compiler.
    """
    if "daqp" not in installed("native"):
        raise InputError("compares the step with DAQP: pip install daqp", field="bench")
    if not usable():
        raise InputError("measures compiled steps", field="bench")
    steps = 6 if quick else 250
    repeat = 1 if quick else REPEAT
    found: dict[str, Any] = {"quick": quick, "machine": machine()}
    load = f"load before the run {_load()}"
    twice = 1 if quick else 2
    at = places(steps)
    some = places(4 if quick else 60)
    scenes = dict([*SCENES.items()][:1]) if quick else SCENES
    large = dict([*LARGE.items()][:1]) if quick else LARGE
    each: dict[str, Callable[[], Any]] = {
        "certification": lambda: certification(some, twice),
        "run": lambda: whole_run(6 if quick else 300, 1 if quick else RUNS),
        "derivatives": lambda: of_derivatives(2 if quick else 100, twice),
        "solids": lambda: solid_scenes(scenes, 3 if quick else SOLID_STEPS, 1 if quick else RUNS),
        "large": lambda: solid_scenes(large, 2 if quick else LARGE_STEPS, twice, large=True),
    }
    grasp = GraspSteps(at)
    for name, measured in each.items():
        tell(name)
        found[name] = measured()
        grasp.take(repeat)
    found["grasp"] = grasp.costs()
    found["machine"]["load"] = f"{load}, after it {_load()}"
    found["promises"] = promises(found)
    return found


def machine() -> dict[str, Any]:
    """What was measured on, and what was measured."""
    return {"quasistatic_ref": __version__, "numpy": np.__version__, **computer.machine()}


def _load() -> str:
    """How many processes wanted to run in the last minute."""
    return f"{os.getloadavg()[0]:.1f}"
