"""All figures of the benchmark, and the page of them."""

import os
from collections.abc import Callable, Mapping
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.lab import machine as computer
from quasistatic_ref.lab.bench.six import FIGURES, SCENES, figures
from quasistatic_ref.lab.markdown import markdown_table
from quasistatic_ref.optional.compiled.library import missing

GROWTH = ("10 boxes", "40 boxes", "200 boxes")
"""Scenes each of which is compared with the one before."""
WORDS = """Microseconds. A step: the median of the least processor times of up to ten steps at a
time, which take turns in one process. A run: all that a run does with `fast` and a light record,
its findings included, by the wall, divided by its steps. The plain step is proved; that of 200
boxes is not measured. Boxes lie apart on a floor, have four contacts each, and slide askew.
MuJoCo's is `mj_step` of the same boxes, and of a box of the bunny's mass between two fingers, with
12 contacts, from rest each time (`pip install "quasistatic-ref[engines]"`)."""


def measured(quick: bool, tell: Callable[[str], None]) -> dict[str, Any]:
    """Times of every scene; `quick` measures a few steps of two, to see that it runs.

    Parameters
    ----------
    quick : bool
    tell : callable
        Called with a scene and what of it is measured next.
    """
    before = os.getloadavg()[0]
    scenes = {}
    for name, (make, steps, repeat) in [*SCENES.items()][: 2 if quick else None]:
        often = (3, 1) if quick else (steps, repeat)
        scenes[name] = figures(make(), *often, tell=partial(_of_scene, name, tell))
    machine = {"quasistatic_ref": __version__, "numpy": np.__version__, **computer.machine()}
    machine["compiled"] = missing() or "yes"
    load = f"load before the run {before:.1f}, after it {os.getloadavg()[0]:.1f}"
    return {"quick": quick, "machine": {**machine, "load": load}, "scenes": scenes}


def _of_scene(name: str, tell: Callable[[str], None], what: str) -> None:
    tell(f"{name}: {what}")


def rows(scenes: Mapping[str, Mapping[str, float]]) -> list[tuple[str, ...]]:
    """Times of `scenes` [us] side by side, a scene a row, the first row their names.

    Below them stands how each grows with the number of boxes [-].
    """
    each = [
        (name, *(f"{times[figure]:.0f}" if figure in times else "-" for figure in FIGURES))
        for name, times in scenes.items()
    ]
    for fewer, more in pairwise(name for name in GROWTH if name in scenes):
        one = scenes[fewer]
        other = scenes[more]
        both = one.keys() & other.keys()
        growth = (f"x {other[name] / one[name]:.1f}" if name in both else "-" for name in FIGURES)
        each.append((f"{more} over {fewer.split()[0]}", *growth))
    return [("[us]", *FIGURES), *each]


def page(tables: Mapping[str, Any]) -> str:
    """The tables of a benchmark as a page in Markdown."""
    m = tables["machine"]
    head, *body = rows(tables["scenes"])
    lines = [
        "# What a step costs",
        "",
        f"Written by `quasistatic-ref bench` on one machine ({m['processor']}, {m['cores']} cores, "
        f"{m['system']}, Python {m['python']}, NumPy {m['numpy']}, {m['load']}; compiled code: "
        f"{m['compiled']}).",
        "",
        *markdown_table(head, body),
        "",
        WORDS,
    ]
    return "\n".join(lines) + "\n"
