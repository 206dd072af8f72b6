"""The data of a solve, as CVXPY forms them from a problem."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import cvxpy as cp

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.interruptible import INTERRUPTIBLE

if TYPE_CHECKING:
    from cvxpy.reductions.solvers.solving_chain import SolvingChain

CANON = cp.COO_CANON_BACKEND
"""CVXPY's way of compiling, for problems of any size: the step of ten boxes in a twentieth of the
time of the others, with the same data."""

MOST_ENTRIES = 60_000
"""Most entries of parameters whose map is compiled. With more, CVXPY forms the data of each step
anew, which takes less time than to compile them and to apply the map."""


@dataclass(frozen=True, eq=False)
class ProblemData:
    """A compiled CVXPY problem: what ``cvxpy.Problem.get_problem_data`` returns.

    Parameters
    ----------
    numbers : dict
        The data of the solver: P, c, A, b and the cones, by CVXPY's words.
    chain : SolvingChain
        Has ``solve_via_data``.
    inverse : list
        What ``unpack_results`` leads back to the problem with.
    """

    numbers: dict[str, Any]
    chain: SolvingChain
    inverse: list[Any]


def problem_data(problem: cp.Problem, name: str, options: Options) -> ProblemData:
    """The data as CVXPY forms them, for any backend.

    The first call compiles the problem, unless its parameters are many: their values then count as
    constants, in each call.
    """
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        data = problem.get_problem_data(
            INTERRUPTIBLE.get(name, name.upper()),
            ignore_dpp=is_large(problem),
            canon_backend=CANON,
            solver_opts=options,
        )
    if any("not DPP" in str(one.message) for one in warned):
        words = f"{name} takes no quadratic cost: CVXPY compiles each step anew, which takes longer"
        warnings.warn(words, stacklevel=2)
    return ProblemData(*data)


def is_large(problem: cp.Problem) -> bool:
    """Whether a problem has more entries of parameters than are compiled."""
    return bool(sum([parameter.size for parameter in problem.parameters()]) > MOST_ENTRIES)
