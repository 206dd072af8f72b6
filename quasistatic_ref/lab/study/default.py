"""The default study: all solvers that are installed on a part of contact-qp."""

from concurrent.futures import Executor
from pathlib import Path

from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.problems.names import NATURAL, RAW
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.problems.selection import in_random_order, problems_taken
from quasistatic_ref.lab.study.row import Row
from quasistatic_ref.lab.study.run import study
from quasistatic_ref.lab.study.solvers import SETTINGS

FAMILIES = {
    "moving": 24,
    "scenarios": 32,
    "time_step": 20,
    "closest_points": 16,
    "contacts": 20,
    "mass_ratio": 20,
    "bodies": 10,
    "condition": 16,
    "gaps": 16,
    "friction": 16,
    "copies": 16,
    "near_copies": 16,
    "narrow": 16,
    "capped_wedge": 20,
    "limits": 20,
    "large": 8,
    "infeasible": 12,
    "jammed": 12,
}
"""Of each family so many problems, evenly along its dial, and two sequences whole."""
QUICK = 20
"""By how much a quick study divides the number of problems."""
EVERY = 3
"""Of raw units every third problem is enough."""
LIMITS = Limits(time_limit=1.0, budget=120.0)


def default_problems(quick: bool = False) -> tuple[list[Problem], list[Problem]]:
    """The problems of the default study, and the part of them for raw units.

    Parameters
    ----------
    quick : bool
        A twentieth of the problems, each family keeping one.
    """
    divisor = QUICK if quick else 1
    families = {name: -(-count // divisor) for name, count in FAMILIES.items()}
    problems = problems_taken(families)
    return problems, in_random_order(problems)[::EVERY]


def default_study(
    folder: str | Path,
    executor: Executor | None = None,
    *,
    quick: bool = False,
    progress: bool = True,
) -> list[Row]:
    """Run the default study, or what is left of it: two calls of :func:`.study`.

    Parameters
    ----------
    folder : str or Path
    executor : Executor, optional
    quick : bool
        A twentieth of the problems, each family keeping one.
    progress : bool

    Returns
    -------
    list of Row
        All rows of the folder.
    """
    problems, part = default_problems(quick)
    by_units = ((problems, ["qpsolvers:*", "cvxpy:*"], NATURAL), (part, ["qpsolvers:*"], RAW))
    rows: list[Row] = []
    for these, solvers, units in by_units:
        rows = study(these, solvers, SETTINGS, folder, executor, units=[units], limits=LIMITS,
                     progress=progress)  # fmt: skip
    return rows
