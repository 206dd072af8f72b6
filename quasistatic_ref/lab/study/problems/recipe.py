"""Which problems ``contact-qp-1`` was made of."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.study.problems.families.dials import DIALS, turned
from quasistatic_ref.lab.study.problems.families.drawn import drawn
from quasistatic_ref.lab.study.problems.families.harvest import Count, no_count
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.families.windows import windows


@dataclass(frozen=True)
class Recipe:
    """How a set is made; what it is, its files say.

    Parameters
    ----------
    name : str
    seed : int
    families : mapping of str to int
        Problems of each; ``sequences`` takes whole windows of every scenario.
    """

    name: str
    seed: int
    families: Mapping[str, int]


CONTACT_QP_1: Final = Recipe(
    "contact-qp-1",
    1,
    {
        "sequences": 480,
        "scenarios": 800,
        "time_step": 240,
        "closest_points": 90,
        "contacts": 150,
        "mass_ratio": 300,
        "bodies": 60,
        "condition": 320,
        "gaps": 280,
        "friction": 320,
        "copies": 240,
        "near_copies": 320,
        "narrow": 280,
        "wedge": 240,
        "infeasible": 300,
        "ellipsoid": 200,
        "sparse": 24,
    },
)


def family_steps(
    family: str, count: int, seed: int, count_steps: Count = no_count
) -> Iterator[Made]:
    """The steps of one family.

    Parameters
    ----------
    family : str
    count : int
    seed : int
    count_steps : callable
        Is called with the number of steps of scenarios that were just simulated.
    """
    if family in DIALS:
        yield from turned(family, count, seed)
        return
    names = tuple(scenario_names())
    if family == "sequences":
        for name in names:
            yield from windows(name, count=count_steps)
        return
    yield from drawn(family, count, seed, names, count_steps=count_steps)
