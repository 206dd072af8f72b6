"""Steps with a user's own constraints and costs.

An extension that is nothing but linear equations and inequalities and a quadratic cost is read
once, as rows and a cost of the step: they are then certified like the step's own, and travel in its
file. Anything else (other costs, curved constraints, further variables that no equation binds) is
solved as a conic program whose residuals are reported. Private rises are coordinates and rows of
the step, too. CVXPY is imported for terms alone: rows and rises are numbers already.
"""

from collections.abc import Callable
from typing import Any

from quasistatic_ref.errors import BackendError, InputError, StepDataError
from quasistatic_ref.optional.extensions.extension import checked_extension, none
from quasistatic_ref.optional.extensions.own_rows import joined, with_numbers
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.step_solver import StepSolver
from quasistatic_ref.solve.backends import DEFAULT, Certify
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import StepExtension
from quasistatic_ref.step.solution import StepSolution


def posed(step: StepData, extension: StepExtension) -> tuple[StepData, bool]:
    """A step with the extension's rows and cost as data, and whether nothing is left out."""
    extension = checked_extension(extension)
    step = with_numbers(step, extension)
    if extension.terms is none:
        return step, not extension.without_stiffness
    from quasistatic_ref.optional.extensions.by_cvxpy import extension_data

    terms = extension_data(step, extension)
    if terms is None:
        return step, False
    try:
        return step.replace(extra=joined(step.extra, terms)), True
    except StepDataError:
        if terms.cost is None:
            raise
        return step, False  # rounding leaves too little of H beside so large a cost


def extended_solution(
    step: StepData,
    extension: StepExtension,
    solver: str | Callable[..., Any] | Solver | None,
    accuracy: float,
    certify: Certify,
) -> StepSolution:
    """What :func:`~quasistatic_ref.solve.solve.solve_step` returns for a step with an extension.

    Parameters
    ----------
    step, extension, solver, accuracy, certify
        As of `solve_step`; accuracy in natural units [-].

    Raises
    ------
    BackendError
        If the extension is more than rows and a quadratic cost, and the solver takes no more.
    """
    own = checked_extension(extension)
    step, whole = posed(step, own)
    if whole:
        return solve_step(step, solver, accuracy=accuracy, certify=certify)
    if isinstance(solver, Solver) or callable(solver):
        words = f"{solver.name}, {solver.interface}" if isinstance(solver, Solver) else "function"
        problem = "takes linear constraints and quadratic costs only; for other costs or a "
        problem += "nonlinear constraint pass the name of a backend"
        raise BackendError(problem, field="backend", value=words)
    from quasistatic_ref.optional.extensions.by_cvxpy import cvxpy_solution

    name = DEFAULT if solver is None else solver
    return cvxpy_solution(step, own, name, accuracy, certify)


def simulated_solution(
    simulator: StepSolver, step: StepData, extension: StepExtension
) -> StepSolution:
    """The solution of a step of a simulator, whose solver serves all steps with linear rows.

    Raises
    ------
    InputError
        Under Coulomb's law, if the extension is more than rows and a quadratic cost.
    """
    own = checked_extension(extension)
    step, whole = posed(step, own)
    if whole:
        return simulator.solution(step)
    if simulator.law != CONVEX:
        problem = (
            "holds nonlinear constraints or costs that are not quadratic, which "
            f'law = "{simulator.law}" does not take; say them as linear constraints and quadratic '
            "costs"
        )
        raise InputError(problem, field="extension")
    from quasistatic_ref.optional.extensions.by_cvxpy import cvxpy_solution

    named = simulator.named_backend
    name = DEFAULT if named is None or named in simulator.replaceable else named
    return cvxpy_solution(step, own, name, simulator.accuracy, simulator.certify)
