"""Which solver a step gets: by the name of its backend, and by which interface that is called."""

from collections.abc import Callable
from typing import Any

from quasistatic_ref.errors import check_kind
from quasistatic_ref.parts import part
from quasistatic_ref.solve.backends import (
    DAQP,
    DEFAULT,
    NONE,
    QPSOLVERS,
    check_backend,
    is_function,
    name_here,
)
from quasistatic_ref.solve.solver import NoSolver, Solver
from quasistatic_ref.step.data import StepData

FunctionSolver = Callable[[StepData, str | Callable[..., Any]], Solver]
NamedSolver = Callable[[StepData, str], Solver]


def solver_for(step: StepData, name: str | Callable[..., Any] | None = None) -> Solver:
    """A solver of steps like this one.

    Parameters
    ----------
    step : StepData
    name : str or callable, optional
        Of the backend, by default Clarabel. With ``qpsolvers:`` it is reached through qpsolvers;
        ``"daqp"`` by its own interface, in workspaces that are kept from step to step; any other,
        and ``"cvxpy:daqp"``, through CVXPY, whose own words, as ``cvxpy.OSQP``, are names, too.
        Or a function (P, q, G, h) -> (x, z, status), also as ``MODULE:FUNCTION``: see
        :mod:`~quasistatic_ref.optional.extensions.by_function`.

    Raises
    ------
    BackendError
        If the backend is unknown or not installed, or does not take the cone.
    InputError
        If the folder of the optional part that calls it is not there.
    """
    if callable(name) or (isinstance(name, str) and is_function(name)):
        function_solver: FunctionSolver = part("function_solver")
        return function_solver(step, name)
    name = DEFAULT if name is None else name_here(name)
    check_kind(name, str, "backend", "the name of a backend, a function or a Solver")
    check_backend(name, step.cone)
    if name == NONE:
        return NoSolver(step, name)
    if name.startswith(QPSOLVERS):
        qpsolvers_solver: NamedSolver = part("qpsolvers_solver", name)
        return qpsolvers_solver(step, name)
    if name == DAQP:
        daqp_solver: NamedSolver = part("daqp_solver")
        return daqp_solver(step, name)
    # CVXPY takes longer to import than a short run.
    from quasistatic_ref.solve.step_problem import CvxpySolver

    return CvxpySolver(step, name)
