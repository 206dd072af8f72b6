"""Which formula the wrong parts of known scenes point to: planted mistakes are known by theirs.

``planted.json.gz`` has mistakes of one place in the plain program, each with the parts of the
scenes in ``validation/scenes`` that it moves wrongly in their first step, in which way, and how far
(``validation/make/planted_runs.py``). A mistake in another program's formula for the same thing
moves nearly the same ones wrongly, in whatever way it is written.
"""

import gzip
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from quasistatic_ref.lab.oracle.parts import ENDED, Part
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.step.arrays import Array

WAY, WHERE = 0.4, 0.3
"""What it adds to the likeness of a part that two mistakes move wrongly that they do it in the same
way, and by the same; that both do counts for the rest [-]."""
LEAST = 0.1
"""Likeness below which nothing is said [-]."""
NEARLY = 0.8
"""A second formula is said if it is that nearly as like as the first [-]."""
SAME = 1e-6
"""How far a state may be from the start of a known scene [m, rad, -]."""
Wrong = Mapping[str, tuple[str, Array]]
"""By scene and part, the way and the offset of each that is wrong."""


class Planted(NamedTuple):
    """A mistake in the plain program.

    Parameters
    ----------
    subjects : tuple of str
        What its line computes.
    layer : str
        The first whose committed cases run the line.
    place : str
    wrong : Wrong
    """

    subjects: tuple[str, ...]
    layer: str
    place: str
    wrong: Wrong


class Diagnosis(NamedTuple):
    """Where a mistake is.

    Parameters
    ----------
    layer : str
    formulas : tuple of str
        One or two things of which one is computed wrongly.
    place : str
        A function, file and line of the plain program.
    likeness : float
        Of the planted mistake that is the most alike [-].
    """

    layer: str
    formulas: tuple[str, ...]
    place: str
    likeness: float


@cache
def planted() -> tuple[dict[str, list[float]], list[Planted]]:
    """The known scenes, by name h and where they start; and the mistakes that come along."""
    path = files("quasistatic_ref.lab.oracle") / "planted.json.gz"
    found = json.loads(gzip.decompress(path.read_bytes()))
    mistakes = [
        Planted(tuple(subjects), layer, place, {n: (way, np.array(v)) for n, (way, v) in w.items()})
        for (subjects, layer, w), place in zip(found["mistakes"], found["places"], strict=True)
    ]
    return found["scenes"], mistakes


def is_known(scenario: Scenario) -> bool:
    """Whether mistakes were planted for a scene."""
    known = planted()[0].get(scenario.path.stem, [])
    own = start_of(scenario)
    return len(known) == len(own) and bool(np.allclose(known, own, rtol=0.0, atol=SAME))


def start_of(scenario: Scenario) -> list[float]:
    """What a scene is known by: h, and where it starts."""
    return [scenario.h, *scenario.system.q_start.tolist()]


def likeness(one: Wrong, other: Wrong) -> float:
    """How alike two sets of wrong parts are: the share of their union that both have [-]."""
    both = one.keys() & other.keys()
    alike = sum(_of_part(*one[name], *other[name]) for name in both)
    return alike / len(one.keys() | other.keys())


def _of_part(way: str, off: Array, other_way: str, other: Array) -> float:
    if ENDED in (way, other_way):
        return float(way == other_way) or (1 - WAY - WHERE) / 2
    words = zip(way.split(", "), other_way.split(", "), strict=True)
    same = float(np.mean([a == b for a, b in words]))
    a, b = sorted((float(np.linalg.norm(off)), float(np.linalg.norm(other))))
    direction = max(0.0, float(off @ other)) / (a * b)
    return 1 - WAY - WHERE + WAY * same + WHERE * direction * float(np.sqrt(a / b))


def diagnosis(parts: Mapping[str, Sequence[Part]]) -> Diagnosis | None:
    """What the planted mistakes that are the most alike have.

    Parameters
    ----------
    parts : mapping
        By scene, all of its parts.

    Returns
    -------
    Diagnosis or None
        None if no part is wrong, or all mistakes are too unlike.
    """
    every = {f"{scene}: {part.name}": part for scene, own in parts.items() for part in own}
    wrong = {name: (part.way, part.off) for name, part in every.items() if part.way}
    best: dict[str, tuple[float, Planted]] = {}
    for mistake in planted()[1] if wrong else ():
        theirs = {name: mistake.wrong[name] for name in mistake.wrong.keys() & every.keys()}
        like = likeness(wrong, theirs)
        for subject in mistake.subjects:
            if subject not in best or like > best[subject][0]:
                best[subject] = like, mistake
    ranked = sorted(best, key=lambda subject: -best[subject][0])
    if not ranked or best[ranked[0]][0] < LEAST:
        return None
    like, first = best[ranked[0]]
    further = [subject for subject in ranked[1:2] if best[subject][0] >= NEARLY * like]
    return Diagnosis(first.layer, (ranked[0], *further), first.place, like)
