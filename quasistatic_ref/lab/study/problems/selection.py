"""The problems of a study that are taken from a set, evenly along the dial of each family."""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read
from quasistatic_ref.lab.folders import problem_set_folder
from quasistatic_ref.lab.study.problems.dials import DIALS
from quasistatic_ref.lab.study.problems.folder import MANIFEST, manifest, set_read
from quasistatic_ref.lab.study.problems.problem import QP, Problem


def set_identity(source: str) -> dict[str, Any]:
    """Name of a set, and the hash of its manifest: what a store says it took problems from."""
    folder = problem_set_folder(source)
    content = bytes_read(folder / MANIFEST)
    return {"name": manifest(folder)["name"], "sha256": hashlib.sha256(content).hexdigest()}


def problems_taken(
    source: str, families: Mapping[str, int], most: Mapping[str, float]
) -> list[Problem]:
    """The problems that a study takes from a set.

    Parameters
    ----------
    source : str
        A name, or a folder.
    families : mapping of str to int
        How many of each.
    most : mapping of str to float
        Where dials end [of the dial].

    Raises
    ------
    InputError
        If a family is not there, or has cones, for which studies have no place.
    """
    wanted = {name: count for name, count in families.items() if count}
    every = set_read(problem_set_folder(source), list(wanted))
    found: list[Problem] = []
    for family, count in wanted.items():
        own = [one for one in every if one.facts["family"] == family]
        if not all(one.facts["kind"] == QP for one in own):
            words = "has cones; studies contain rows only"
            raise InputError(words, field="problems.families", value=family)
        found += problems_along_dial(own, family, count, most.get(family))
    return found


def problems_along_dial(
    own: Sequence[Problem], family: str, count: int, most: float | None = None
) -> list[Problem]:
    """Some problems of a family, evenly along its dial; of sequences whole ones, in order.

    Parameters
    ----------
    own : sequence of Problem
        All of the family.
    family : str
    count : int
        At most so many.
    most : float, optional
        Where the dial ends [its unit].
    """
    dial = DIALS.get(family)
    if most is not None and dial is not None:
        up = dial["first"] < dial["most"]
        own = [one for one in own if (one.facts["dial"] <= most) == up or one.facts["dial"] == most]
    if own and own[0].facts["sequence"] is not None:
        names = list(dict.fromkeys(one.facts["sequence"]["name"] for one in own))
        length = len(own) // len(names)
        kept = {names[i] for i in evenly(len(names), max(count // length, 1))}
        return [one for one in own if one.facts["sequence"]["name"] in kept]
    order = own if dial is None else sorted(own, key=lambda one: float(one.facts["dial"]))
    return [order[i] for i in evenly(len(order), count)]


def evenly(there: int, count: int) -> list[int]:
    """At most `count` places of those `there`, first and last among them."""
    places = np.linspace(0, there - 1, min(count, there)).round().astype(int)
    return [int(i) for i in np.unique(places)]
