"""What solves a step in parts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from quasistatic_ref.parts import needing

if TYPE_CHECKING:
    from quasistatic_ref.certify.optimum import StepSolution
    from quasistatic_ref.solve.backends import Certify
    from quasistatic_ref.solve.solver import Solver
    from quasistatic_ref.step.data import StepData
    from quasistatic_ref.step.extension import StepExtension


def extended_step(
    step: StepData,
    extension: StepExtension,
    solver: str | Callable[..., Any] | Solver | None,
    fast: bool,
    accuracy: float,
    certify: Certify,
) -> StepSolution:
    """``extension``: a step solved with it, from the arguments of ``solve_step``."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions.extended import extended_step as extended
    return extended(step, extension, solver, fast, accuracy, certify)


def posed(step: StepData, extension: StepExtension) -> tuple[StepData, bool]:
    """``extension``: a step with what of it is data, and whether that is all of it."""
    with needing("extension"):
        from quasistatic_ref.optional.extensions import extended
    return extended.posed(step, extension)


def fast_solver(step: StepData, name: str | None) -> Solver:
    """``fast``: its solver of steps like this one, by the name of a backend."""
    with needing("fast"):
        from quasistatic_ref.optional.fast.solver import fast_solver as fast
    return fast(step, name)


def function_solver(step: StepData, function: str | Callable[..., Any]) -> Solver:
    """``backend = "MODULE:FUNCTION"``: a solver of steps like this one that asks a function."""
    with needing("a function as backend"):
        from quasistatic_ref.optional.extensions.by_function import FunctionSolver
    return FunctionSolver(step, function)


def qpsolvers_solver(step: StepData, name: str) -> Solver:
    """``qpsolvers:NAME``: the solver of steps like this one."""
    with needing(name):
        from quasistatic_ref.optional.qpsolvers.through_qpsolvers import QpsolversSolver
    return QpsolversSolver(step, name)
