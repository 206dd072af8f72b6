"""Which parts of the scenes for comparisons the mistakes of one place move wrongly.

Run ``python -m validation.make.planted_runs --out FILE`` (a quarter of an hour); the file is
``quasistatic_ref/lab/oracle/planted.json.gz``, by which ``compare`` says where to look. The first
``--first`` changes of the plain program (``program_changes``) are made, one at a time; each changed
program takes the first step of each scene. Run it with ``OPENBLAS_NUM_THREADS=1``:
threads that wait spend processor time, after STEP of which a change has no step.
"""

import gzip
import json
import signal
import sys
import warnings
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.lab.oracle.alike import hash_of
from quasistatic_ref.lab.oracle.comparison import DIGITS
from quasistatic_ref.lab.oracle.parts import parts_of
from quasistatic_ref.lab.oracle.scene_case import SceneCases
from quasistatic_ref.lab.vectors.check.patched import Program, program_of
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.step.arrays import Array
from validation.make.fingerprints import FIRST, fingerprint, known
from validation.make.program_changes import Change, changes
from validation.tools.scripts import ROOT, script_options

SCENES = ("free", "joints", "keys", "solids", "gripped", "pushed")
FILE = ROOT / "quasistatic_ref/lab/oracle/planted.json.gz"
STEP = 10.0
"""Processor time after which a scene has no step, nor those after it [s]."""
FIGURES = 3
"""Digits of an offset that are kept."""
Step = tuple[Scenario, Json, StepResult]


@cache
def scene(name: str) -> Scenario:
    """One of the scenes for comparisons."""
    return load_scenario(ROOT / "validation" / "scenes" / f"{name}.toml")


@cache
def first_step(name: str) -> Step:
    """The first step of a scene, as a case, and the reference's."""
    one = scene(name)
    q = one.system.q_start
    force = 0.0 if one.force is None else one.force(one.h, q)
    return one, SceneCases(one).at(0, q), one.simulator().step(q, one.targets(one.h), force)


def _end(*_: Any) -> None:
    raise TimeoutError


@np.errstate(all="ignore")
def q_after(program: Program, name: str) -> Array | None:
    """Where a changed program ends the first step of a scene; None if it takes none."""
    one, case, result = first_step(name)
    try:
        q = one.system.normalised(np.array(program("step", case)["q_next"], dtype=np.float64))
        return q if np.isfinite(one.system.difference(result.q, q)).all() else None
    except TimeoutError:
        raise
    except Exception:  # a changed program may fail in any way
        return None


def moved(change: Change) -> Json:
    """By scene and part, the way and the offset of each that a change moves wrongly."""
    program = program_of({change.file: change.text})
    before = signal.signal(signal.SIGPROF, _end)
    found = {}
    hangs = False
    for name in SCENES:
        signal.setitimer(signal.ITIMER_PROF, STEP)
        try:
            q = None if hangs else q_after(program, name)
        except TimeoutError:
            q, hangs = None, True
        signal.setitimer(signal.ITIMER_PROF, 0)
        one, _, result = first_step(name)
        for part in parts_of(one.system, result, q, DIGITS):
            if part.way:
                off = [float(f"{x:.{FIGURES}g}") for x in part.off.tolist()]
                found[f"{name}: {part.name}"] = [part.way, off]
    signal.signal(signal.SIGPROF, before)
    return found


def layer_of(change: Change) -> str:
    """The first layer whose committed cases run the line of a change, else its function; or ""."""
    runs = known().runs
    numbers = runs[change.file, change.line] or runs[change.file, change.function]
    layers = {known().cases[i].question.layer for i in numbers}
    return min(layers, key=LAYERS.index, default="")


def content(found: Sequence[tuple[Change, Json]]) -> bytes:
    """The file: of mistakes of one subject that move the same, the first."""
    mistakes: list[Json] = []
    places: list[str] = []
    for change, wrong in found:
        subjects, place, _ = fingerprint(change)
        one = [list(subjects), layer_of(change), wrong]
        if wrong and one not in mistakes:
            mistakes.append(one)
            places.append(f"{place}, line {change.line}")
    scenes = {name: hash_of(first_step(name)[1]) for name in SCENES}
    whole = {"scenes": scenes, "mistakes": mistakes, "places": places}
    return gzip.compress(json.dumps(whole, separators=(",", ":")).encode(), mtime=0)


def main() -> int:
    """Make the file."""
    options = script_options(__doc__, out=Path, first=FIRST)
    warnings.simplefilter("ignore")
    made = []
    for number, change in zip(range(options.first), changes(), strict=False):
        made.append((change, moved(change)))
        if number % 100 == 0:
            print(number, file=sys.stderr, flush=True)
    (options.out or FILE).write_bytes(content(made))
    return 0


if __name__ == "__main__":
    sys.exit(main())
