"""Every family with its dial: the number that makes its problems harder, from where to where."""

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypedDict

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.scenes.slabs import slab_step, tower_step
from quasistatic_ref.lab.study.problems.families.contradicting import (
    between_walls,
    in_a_cage,
    in_a_wedge,
    under_a_ceiling,
)
from quasistatic_ref.lab.study.problems.families.limited import at_its_limits, within_limits
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.families.shaped import (
    conditioned,
    copied,
    nearly_copied,
    rubbed,
    spaced,
)
from quasistatic_ref.lab.study.problems.families.short import H, short_step, with_axes
from quasistatic_ref.lab.study.problems.families.walls import brick_wall
from quasistatic_ref.step.data import StepData

Turned = Callable[[Rng, float], StepData]
FIGURES = 6
"""Significant figures of a dial's value, which the problem's name has."""


@dataclass(frozen=True)
class Dial:
    """A family in which one number is turned.

    Parameters
    ----------
    name : str
        Of the number.
    unit : str
    first, most : float
        Its easy and its hard end [the unit].
    scenes : tuple of (str, callable)
        A tag ("" for none) and the scene, in turn; ``(generator, value) -> step``.
    whole : bool
        Whether it is a whole number.
    solvable : bool
        Whether its problems have a solution.
    """

    name: str
    unit: str
    first: float
    most: float
    scenes: tuple[tuple[str, Turned], ...]
    whole: bool = False
    solvable: bool = True

    def values(self, count: int, most: float | None = None) -> list[float]:
        """So many values from the easy end to the hard one, or to another.

        Parameters
        ----------
        count : int
        most : float, optional
            The other end [the unit].
        """
        end = self.most if most is None else most
        scale = np.geomspace(self.first, end, count) if count > 1 else np.array([end])
        rounded = scale.round() if self.whole else scale
        return [float(f"{v:.{FIGURES}g}") for v in rounded.tolist()]


def _contacts(rng: Rng, value: float) -> StepData:
    return with_axes(rng, short_step(slab_step(rng, round(value), 10.0, H)))


def _ratio(rng: Rng, value: float) -> StepData:
    return with_axes(rng, short_step(slab_step(rng, 12, value, H)))


def _tower(rng: Rng, value: float) -> StepData:
    return with_axes(rng, short_step(tower_step(rng, round(value))))


def _overlap(scene: Turned) -> Turned:
    return lambda rng, value: scene(rng, -value)


DIALS = {
    "contacts": Dial("contacts", "-", 2, 200, (("", _contacts),), whole=True),
    "mass_ratio": Dial("ratio of masses", "-", 1, 1e9, (("", _ratio),)),
    "bodies": Dial("bodies", "-", 2, 10, (("", _tower),), whole=True),
    "condition": Dial("condition of K_q", "-", 1, 1e12, (("dense", conditioned),)),
    "gaps": Dial("largest gap", "m", 1e-2, 1e-14, (("", spaced),)),
    "friction": Dial("friction coefficient", "-", 1e-3, 1e3, (("", rubbed),)),
    "copies": Dial("copies of each contact", "-", 1, 16, (("dependent", copied),), whole=True),
    "near_copies": Dial("difference of two contacts", "-", 1e-1, 1e-9,
                        (("nearly dependent", nearly_copied),)),
    "narrow": Dial("room", "m", 1e-3, 1e-13,
                   (("nearly infeasible", between_walls), ("nearly infeasible", in_a_cage))),
    "capped_wedge": Dial("angle", "rad", 1e-1, 1e-8, (("nearly infeasible", in_a_wedge),)),
    "limits": Dial("room of a joint", "m, rad", 1e-2, 1e-13, (("limits", within_limits),)),
    "large": Dial("bodies", "-", 5, 50, (("wall", brick_wall),), whole=True),
    "infeasible": Dial("overlap", "m", 1e-2, 1e-13,
                       (("walls", _overlap(between_walls)), ("cage", _overlap(in_a_cage))),
                       solvable=False),
    "jammed": Dial("overlap", "m", 1e-2, 1e-13,
                   (("limits", _overlap(at_its_limits)), ("tower", _overlap(under_a_ceiling))),
                   solvable=False),
}  # fmt: skip
"""Of families that are made."""

SCENARIOS = "scenarios"
OTHERS = {
    SCENARIOS: None,
    "sequences": ("steps between one problem and the next", "-", 1.0, 16.0),
    "moving": ("steps between one problem and the next", "-", 1.0, 16.0),
    "time_step": ("h", "s", 0.1, 1e-4),
    "closest_points": ("k", "-", 1.0, 50.0),
    "wedge": ("angle", "rad", 1e-1, 1e-9),
    "ellipsoid": ("contacts", "-", 2.0, 12.0),
    "sparse": ("bodies", "-", 10.0, 500.0),
}
"""Steps of runs, which have no dial, and families that are found in sets only: name, unit, easy and
hard end of their dials."""


class Ends(TypedDict):
    """Where a dial begins and ends.

    Parameters
    ----------
    name : str
    unit : str
    first : float
        The easy end [the dial's unit].
    most : float
        The hard end, whichever is larger [the dial's unit].
    """

    name: str
    unit: str
    first: float
    most: float


def ends(family: str) -> Ends | None:
    """The dial of a family; None if it has none."""
    if family in DIALS:
        own = DIALS[family]
        found = (own.name, own.unit, own.first, own.most)
    elif (other := OTHERS[family]) is None:
        return None
    else:
        found = other
    name, unit, first, most = found
    return Ends(name=name, unit=unit, first=first, most=most)


def turned(family: str, count: int, seed: int, most: float | None = None) -> Iterator[Made]:
    """The problems of a family, from the easy end of its dial to the hard one.

    Parameters
    ----------
    family : str
    count : int
    seed : int
    most : float, optional
        Another hard end [the dial's unit].
    """
    dial = DIALS[family]
    for i, value in enumerate(dial.values(count, most)):
        yield one_turned(family, value, i, seed)


def one_turned(family: str, value: float, i: int, seed: int, again: int = 0) -> Made:
    """Problem i of a family at a `value` [the dial's unit]; `again` draws another in its place."""
    dial = DIALS[family]
    tag, scene = dial.scenes[i % len(dial.scenes)]
    rng = np.random.default_rng([seed, i, zlib.crc32(family.encode()), again])
    step = scene(rng, value)
    ratio = value if family == "mass_ratio" else 1.0
    name = f"{family}/{value:.{FIGURES}g}/{i}"
    return Made(name, family, step, ratio, 0, value, (tag,) if tag else ())
