"""Copies of CVXPY problems that have been solved, without what was compiled of them.

CVXPY keeps solvers' own objects, which do not pickle; and a deep copy of what it compiled has the
numbers of the variables and parameters that it was copied from.
"""

import copy

import cvxpy as cp

from quasistatic_ref.errors import InputError


def uncompiled(problem: cp.Problem) -> cp.Problem:
    """A problem of the same objective, constraints and solution, of which nothing is compiled."""
    kept = cp.Problem(problem.objective, problem.constraints)
    solution = problem.solution
    if solution is not None:
        values = {**solution.primal_vars}, {**solution.dual_vars}
        solution = type(solution)(solution.status, solution.opt_val, *values, {})
    vars(kept).update(_solution=solution, _status=problem.status, _value=problem.value)
    return kept


def give_solution(problem: cp.Problem, other: cp.Problem) -> None:
    """Give a problem the solution of another one that was made in the same way."""
    solution = copy.deepcopy(uncompiled(other).solution)
    if solution is None:
        return
    numbers = dict(zip(_numbers(other), _numbers(problem), strict=True))
    for of in ("primal_vars", "dual_vars"):
        values = getattr(solution, of).items()
        setattr(solution, of, {numbers[key]: value for key, value in values})
    problem.unpack(solution)


def _numbers(problem: cp.Problem) -> list[int]:
    """CVXPY's numbers of the variables and constraints, in their order."""
    return [part.id for part in (*problem.variables(), *problem.constraints)]


def unknown_additions(page: object) -> list[cp.Constraint | cp.Expression]:
    """The additions of a page that comes from a pickle, which holds what they returned: InputError.

    Parameters
    ----------
    page : StepProblem
    """
    problem = "does not hold the function of its additions; copy it by another pickle"
    raise InputError(problem, field="a StepProblem from a pickle")
