"""Which formula the wrong parts of known scenes point to: that of planted mistakes like them.

``planted.json.gz`` has mistakes of one place in the plain program, each with the parts of the
scenes in ``validation/scenes`` that it moves wrongly in their first step, in which way, and how far
(``validation/make/planted_runs.py``). A mistake in another program's formula for the same thing
moves nearly the same ones wrongly, in whatever way it is written.
"""

import gzip
import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.oracle.parts import ENDED, Part
from quasistatic_ref.lab.oracle.scene_case import SceneCases
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.step.arrays import Array

WAY = 0.4
"""Weight of the same way in the likeness of a part that both move wrongly [-]."""
WHERE = 0.3
"""Weight of the same offset in it; the rest is for both being wrong [-]."""
NEARLY = 0.8
"""What is like by that share of the most alike may as well be it [-]."""
MOST = 2
"""Formulas that may be it, if anything is said."""
DECIMALS = 10
"""By which a scene is known: the last bits of a number depend on the machine."""
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
def planted() -> tuple[dict[str, str], list[Planted]]:
    """The known scenes, the hash of each by its name; and the mistakes that come along."""
    path = files("quasistatic_ref.lab.oracle") / "planted.json.gz"
    found = json.loads(gzip.decompress(path.read_bytes()))
    mistakes = [
        Planted(tuple(subjects), layer, place, {n: (way, np.array(v)) for n, (way, v) in w.items()})
        for (subjects, layer, w), place in zip(found["mistakes"], found["places"], strict=True)
    ]
    return found["scenes"], mistakes


def known_name(scenario: Scenario) -> str:
    """The name of the scene for which mistakes were planted; "" if it is none of them."""
    try:
        case = SceneCases(scenario).at(0, scenario.system.q_start)
    except InputError:
        return ""
    own = hash_of(case)
    return next((name for name, known in planted()[0].items() if known == own), "")


def hash_of(case: Json) -> str:
    """What a scene is known by: the case of its first step, to DECIMALS."""
    text = json.dumps(_rounded(case), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _rounded(value: Any) -> Any:
    match value:
        case dict():
            return {name: _rounded(one) for name, one in value.items()}
        case list() | tuple() | np.ndarray():
            return [_rounded(one) for one in value]
        case bool() | str() | None:
            return value
    return round(float(value), DECIMALS) + 0.0  # without the sign of 0


def likeness(one: Wrong, other: Wrong) -> float:
    """How alike two sets of wrong parts are: of the union, the part both have, weighted [-].

    A part that both move wrongly counts as much as its way and its offset are the same.
    """
    both = one.keys() & other.keys()
    alike = sum(_of_part(*one[name], *other[name]) for name in both)
    return alike / len(one.keys() | other.keys())


def _of_part(way: str, off: Array, other_way: str, other: Array) -> float:
    if ENDED in (way, other_way):
        return float(way == other_way) or (1 - WAY - WHERE) / 2
    words = zip(way.split(", "), other_way.split(", "), strict=True)
    same = float(np.mean([a == b for a, b in words]))
    lengths = float(np.linalg.norm(off)), float(np.linalg.norm(other))
    a = min(lengths)
    b = max(lengths)
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
        None if no part is wrong, or more than MOST formulas are nearly as like as the first.
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
    if not ranked:
        return None
    like, first = best[ranked[0]]
    near = tuple(subject for subject in ranked if best[subject][0] >= NEARLY * like)
    return Diagnosis(first.layer, near, first.place, like) if len(near) <= MOST else None
