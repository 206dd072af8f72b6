"""What ``contact-qp-2`` is made of: problems of ``contact-qp-1`` as they are, and others."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.folders import CONTACT_QP_1, CONTACT_QP_2
from quasistatic_ref.lab.study.problems.families.harvest import Count, scenario_of
from quasistatic_ref.lab.study.problems.families.windows import windows
from quasistatic_ref.lab.study.problems.making import (
    Family,
    Kept,
    dial_problems,
    problem_of,
    set_made,
)
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.problems.selection import problems_taken

SEED: Final = 2
TAKEN: Final = {
    "scenarios": 80,
    "time_step": 60,
    "closest_points": 40,
    "contacts": 40,
    "mass_ratio": 60,
    "bodies": 30,
    "condition": 60,
    "gaps": 60,
    "friction": 60,
    "copies": 40,
    "near_copies": 60,
    "narrow": 60,
    "infeasible": 60,
}
"""Problems of ``contact-qp-1``, evenly along each dial: of the same names, with the same bits."""
MADE: Final = {"capped_wedge": 80, "limits": 80, "large": 20, "jammed": 60}
"""Problems of dials that it does not have."""
MOVING: Final = "moving"
"""Its sequences; each scenario has up to four."""


def edition_made(folder: Path, progress: bool = True) -> list[Problem]:
    """Make ``contact-qp-2``; the answers of one that was interrupted are not sought again.

    Parameters
    ----------
    folder : Path
    progress : bool
        Whether to show a bar on standard error, where that is a terminal.
    """
    families = {name: _taken(name, count) for name, count in TAKEN.items()}
    families[MOVING] = _moving
    families |= {name: _made(name, count) for name, count in MADE.items()}
    runs = sum(scenario_of(name).steps for name in scenario_names())
    total = sum(TAKEN.values()) + sum(MADE.values()) + runs
    return set_made(CONTACT_QP_2, families, folder, total, progress)


def _taken(family: str, count: int) -> Family:
    return lambda kept, _: iter(problems_taken(CONTACT_QP_1, {family: count}, {}))


def _made(family: str, count: int) -> Family:
    return lambda kept, _: dial_problems(family, count, SEED, kept)


def _moving(kept: Kept, count: Count) -> Iterator[Problem]:
    for name in scenario_names():
        for one in windows(name, count):
            yield problem_of(one, kept)
