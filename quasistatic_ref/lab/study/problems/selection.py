"""The problems of a study that are taken from contact-qp, evenly along the dial of each family."""

import random
from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np

from quasistatic_ref.lab.folders import contact_qp_folder
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.problem import Problem

One = TypeVar("One")


def problems_taken(families: Mapping[str, int]) -> list[Problem]:
    """Problems of contact-qp: of each family so many, evenly along its dial.

    Of a family of sequences whole ones, in order.

    Parameters
    ----------
    families : mapping of str to int
        How many of each, at most.

    Raises
    ------
    InputError
        If a family is not there.
    """
    wanted = {name: count for name, count in families.items() if count}
    every = set_read(contact_qp_folder(), list(wanted))
    chosen: list[Problem] = []
    for family, count in wanted.items():
        chosen += _along_dial([one for one in every if one.family == family], count)
    return chosen


def _along_dial(members: Sequence[Problem], count: int) -> list[Problem]:
    """Some problems of a family, evenly along its dial; of sequences whole ones, in order."""
    if members[0].facts["sequence"] is not None:
        names = list(dict.fromkeys(one.facts["sequence"]["name"] for one in members))
        length = len(members) // len(names)
        kept = {names[i] for i in evenly(len(names), max(count // length, 1))}
        return [one for one in members if one.facts["sequence"]["name"] in kept]
    order = sorted(members, key=lambda one: one.dial or 0.0)
    return [order[i] for i in evenly(len(order), count)]


def evenly(there: int, count: int) -> list[int]:
    """At most `count` places of those `there`, first and last among them."""
    places = np.linspace(0, there - 1, min(count, there)).round().astype(int)
    return [int(i) for i in np.unique(places)]


def in_random_order(problems: Sequence[One]) -> list[One]:
    """Problems in an order that is random and always the same."""
    return random.Random(1).sample(problems, len(problems))
