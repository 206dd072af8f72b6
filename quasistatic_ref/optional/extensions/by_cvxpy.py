"""An extension that is said with CVXPY: read as rows and a cost, or solved as a conic program."""

import warnings
from dataclasses import asdict
from functools import partial

import cvxpy as cp
import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.optional.extensions.conic import conic_program, conic_residuals
from quasistatic_ref.optional.extensions.extension import Extension, Symbols
from quasistatic_ref.optional.extensions.own_rows import joined
from quasistatic_ref.optional.extensions.quadratic import quadratic_program
from quasistatic_ref.optional.extensions.terms import checked_terms
from quasistatic_ref.solve.backends import backend, check_takes_cones
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.step_problem import StepProblem, divided, problem_data
from quasistatic_ref.solve.units import in_si
from quasistatic_ref.step.cones import cone, frictionless
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.problem import set_values
from quasistatic_ref.step.solution import Certificate, SolverStatistics, StepSolution
from quasistatic_ref.step.standard_form import Units, linear_term, page_units, si_units
from quasistatic_ref.tolerances import RESIDUAL_LIMIT


def extension_data(step: StepData, extension: Extension) -> Extra | None:
    """The rows A delta_q >= b and the quadratic cost of an extension; None if it holds more.

    An equation becomes two rows. The numbers are the float64 numbers that CVXPY makes of it. Costs,
    and what binds further variables, are read by
    :func:`~quasistatic_ref.optional.extensions.quadratic.quadratic_program`.

    Parameters
    ----------
    step : StepData
        SI units; with the extension's private rises.
    extension : Extension

    Returns
    -------
    Extra or None
        The extension's rows and cost alone.
    """
    if extension.without_stiffness:
        return None
    # Where h is 1 s, accelerations are displacements, and all numbers of theirs stay as they are.
    problem = StepProblem(step.with_fields(h=1.0))
    terms = _terms(extension, step, si_units(step.n_v), problem)
    costs = [term for term in terms if isinstance(term, cp.Expression)]
    constraints = [term for term in terms if isinstance(term, cp.Constraint)]
    unknowns = (problem.a_a, problem.a_u)
    for x in unknowns:
        x.value = np.zeros(x.shape)
    names: list[str] = []
    A = [np.zeros((0, step.n_v))]
    b = [np.zeros(0)]
    others: list[cp.Constraint] = []
    for k, constraint in enumerate(constraints):
        equation = isinstance(constraint, cp.constraints.Equality | cp.constraints.Zero)
        plain = equation or isinstance(constraint, cp.constraints.Inequality)
        of_delta_q = not {v.id for v in constraint.variables()} - {x.id for x in unknowns}
        if not (plain and of_delta_q and constraint.expr.is_affine()):
            others.append(constraint)
            continue
        value = np.atleast_1d(np.asarray(constraint.expr.value, dtype=np.float64)).ravel("F")
        row = -_coefficients(constraint.expr, unknowns)  # expr <= 0
        labels = [f"extension {k}[{i}]" for i in range(len(value))]
        for sign, end in ((1.0, ""), (-1.0, " reversed"))[: 1 + equation]:
            names += [label + end for label in labels]
            A.append(sign * row)
            b.append(sign * value)
    rows = Extra(tuple(names), np.vstack(A), np.concatenate(b))
    if not (others or costs):
        return rows
    program = quadratic_program(costs, others, unknowns)
    return None if program is None else joined(rows, program)


def cvxpy_solution(
    step: StepData, extension: Extension, name: str, accuracy: float, certify: str
) -> StepSolution:
    """The optimum of a step with an extension that is more than rows and a quadratic cost.

    Parameters
    ----------
    step : StepData
        SI units; with the extension's private rises.
    extension : Extension
    name : str
        A backend that takes cones.
    accuracy : float
        In natural units [-].
    certify : str
        ``"off"``, or anything else for a certificate of kind ``"residual"``.

    Returns
    -------
    StepSolution
        lam and wrench are those of the step's own rows; what an extension pushes with is not in
        them, nor what its costs do in place of a contact.

    Raises
    ------
    BackendError
        If the backend takes no cones.
    StepNotSolved
        If it does not solve the problem, or its residuals are not small.
    """
    check_takes_cones(name, "an extension with nonlinear constraints or costs")
    natural = NaturalStep(step)
    units = natural.units
    if not (linear_term(step).any() or natural.deepest > 0):  # the extension alone drives it
        units = units._replace(size=1.0)
    of_page = page_units(units, step.h)
    problem = StepProblem(step, partial(_terms, extension, step, of_page))
    # An extension may move what no load moves: nothing is out of reach.
    set_values(problem.page, step, units)
    if extension.without_stiffness:  # nothing is left of Eq. (1)
        for parameter in (problem.parameters["K_q"], problem.parameters["tau_k"]):
            parameter.value = np.zeros(parameter.shape)
    failure: StepNotSolved | None = None
    for tried, options in backend(name).attempts(accuracy, curved=True):
        try:
            certificate, statistics = _solved(step, problem, name, tried, dict(options))
        except StepNotSolved as failed:
            failure = failed
            continue
        multipliers = problem.dual()
        if multipliers is None:
            raise StepNotSolved(name, f"{name} gives no multipliers through CVXPY", step, tried)
        delta_q, lam = in_si(problem.primal(), multipliers, of_page)
        claimed = Certificate("none") if certify == "off" else certificate
        return StepSolution(delta_q, lam, step, claimed, statistics, alone=False)
    assert failure is not None  # a backend has at least one set of options
    raise failure


def _terms(
    extension: Extension, step: StepData, units: Units, problem: StepProblem
) -> list[cp.Constraint | cp.Expression]:
    """Constraints and costs of an extension, in the variables of a problem in `units`."""
    symbols = _symbols(problem, step, units, len(extension.rises))
    length = units.size * units.length
    return [
        divided(term, by=length) if isinstance(term, cp.Constraint) else term / units.size**2
        for term in checked_terms(extension, symbols)
    ]


def _symbols(problem: StepProblem, step: StepData, units: Units, private: int) -> Symbols:
    """The symbols of a problem in SI units, of whose coordinates the last ones are private."""
    public = step.n_v - private
    unactuated = step.n_u - private
    coordinate = units.size * units.coordinate[:public]
    length = units.size * units.length
    kind = cone(step.cone)
    rows = kind.function if kind.polyhedral else frictionless  # the gap alone
    return Symbols(
        delta_q=cp.multiply(coordinate, problem.delta_q[:public]),
        delta_q_a=cp.multiply(coordinate[: step.n_a], problem.delta_q_a),
        delta_q_u=cp.multiply(coordinate[step.n_a :], problem.delta_q_u[:unactuated]),
        delta_q_bar_a=cp.Constant(step.delta_q_bar_a),
        slack=tuple(
            length * row[j]
            for row, j in zip(rows(*problem.contact_motion), step.mask.T, strict=False)
        ),
    )


def _solved(
    step: StepData, problem: StepProblem, name: str, accuracy: float, options: dict[str, object]
) -> tuple[Certificate, SolverStatistics]:
    """Solve the conic program and judge the raw answer; its values are left in the problem."""
    try:
        data = problem_data(problem.problem, name, options)
        raw = data.chain.solve_via_data(problem.problem, data.numbers, False, False, options)
        with warnings.catch_warnings():
            # "Solution may be inaccurate" is dealt with below, by the status.
            warnings.filterwarnings("ignore", "Solution may be inaccurate", UserWarning)
            problem.problem.unpack_results(raw, data.chain, data.inverse)
    except cp.error.DCPError as error:
        raise InputError(f"is not convex by CVXPY's rules: {error}", field="extension") from error
    except Exception as error:  # whatever another package raises
        raise StepNotSolved(name, f"the solver failed: {error}", step, accuracy) from error
    status = str(problem.problem.status)
    if status != cp.OPTIMAL:
        raise StepNotSolved(name, status, step, accuracy)
    x, z = (raw["x"], raw["y"]) if isinstance(raw, dict) else (raw.x, raw.z)
    program = conic_program(data.numbers)
    check_arithmetic()
    residuals = conic_residuals(program, np.array(x), np.array(z))
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        problem_words = f"it said {status}, but its worst residual is {residuals.worst:.1e}"
        raise StepNotSolved(name, problem_words, step, accuracy, residuals)
    stats = problem.problem.solver_stats
    statistics = SolverStatistics(name, status, stats.num_iters, stats.solve_time, accuracy)
    return Certificate("residual", asdict(residuals), step=step), statistics


def _coefficients(expr: cp.Expression, unknowns: tuple[cp.Variable, ...]) -> Array:
    """The matrix of an affine expression, shape (size, n_v)."""
    gradient = expr.grad
    size = int(expr.size)
    blocks = []
    for x in unknowns:
        block = gradient.get(x, np.zeros((x.size, size)))
        dense = block.toarray() if hasattr(block, "toarray") else np.asarray(block)
        blocks.append(dense.reshape(x.size, size).T)
    return np.asarray(np.hstack(blocks), dtype=np.float64)
