"""The problems of a study that are taken from a set, evenly along the dial of each family."""

import random
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from quasistatic_ref.lab.folders import problem_set_folder
from quasistatic_ref.lab.study.problems.folder import manifest, set_read
from quasistatic_ref.lab.study.problems.problem import Problem

One = TypeVar("One")


def problems_taken(
    source: str, families: Mapping[str, int], most: Mapping[str, float] | None = None
) -> list[Problem]:
    """The problems that a study takes from a set.

    Parameters
    ----------
    source : str
        A name, or a folder.
    families : mapping of str to int
        How many of each.
    most : mapping of str to float, optional
        Where dials end [of the dial]; else at their hard ends.

    Raises
    ------
    InputError
        If a family is not there.
    """
    wanted = {name: count for name, count in families.items() if count}
    folder = problem_set_folder(source)
    every = set_read(folder, list(wanted))
    known = manifest(folder)["families"]
    chosen: list[Problem] = []
    for family, count in wanted.items():
        members = [one for one in every if one.facts["family"] == family]
        chosen += problems_along_dial(
            members, known[family]["dial"], count, (most or {}).get(family)
        )
    return chosen


def problems_along_dial(
    members: Sequence[Problem],
    dial: Mapping[str, Any] | None,
    count: int,
    most: float | None = None,
) -> list[Problem]:
    """Some problems of a family, evenly along its dial; of sequences whole ones, in order.

    Parameters
    ----------
    members : sequence of Problem
        All of the family.
    dial : mapping or None
        Of the family, as the manifest of the set has it.
    count : int
        At most so many.
    most : float, optional
        Where the dial ends [its unit].
    """
    if most is not None and dial is not None:
        up = dial["first"] < dial["most"]
        members = [
            one for one in members if (one.facts["dial"] <= most) == up or one.facts["dial"] == most
        ]
    if members and members[0].facts["sequence"] is not None:
        names = list(dict.fromkeys(one.facts["sequence"]["name"] for one in members))
        length = len(members) // len(names)
        kept = {names[i] for i in evenly(len(names), max(count // length, 1))}
        return [one for one in members if one.facts["sequence"]["name"] in kept]
    order = members if dial is None else sorted(members, key=lambda one: float(one.facts["dial"]))
    return [order[i] for i in evenly(len(order), count)]


def evenly(there: int, count: int) -> list[int]:
    """At most `count` places of those `there`, first and last among them."""
    places = np.linspace(0, there - 1, min(count, there)).round().astype(int)
    return [int(i) for i in np.unique(places)]


def in_random_order(problems: Sequence[One]) -> list[One]:
    """Problems in an order that is random and always the same."""
    return random.Random(1).sample(problems, len(problems))
