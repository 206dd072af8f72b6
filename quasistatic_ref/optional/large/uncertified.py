"""A solver's own answer, judged by its residuals and by a rigorous bound of its error."""

import math

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.optional.large.judged import WORTHLESS
from quasistatic_ref.solve.scaled import NaturalStep
from quasistatic_ref.solve.solver import Answer, Solver
from quasistatic_ref.solve.units import from_natural, in_natural
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.solution import Certificate, StepSolution, step_solution
from quasistatic_ref.tolerances import RESIDUAL_LIMIT

NOTHING_CLAIMED = Certificate("none")


def uncertified_solution(
    scaled: NaturalStep, solver: Solver, answer: Answer, certify: str
) -> StepSolution:
    """A solver's own answer as a solution in SI units.

    Parameters
    ----------
    scaled : NaturalStep
        Of :meth:`~quasistatic_ref.solve.solver.Solver.scaled`.
    solver : Solver
    answer : Answer
        In the natural units of `scaled` [-].
    certify : str
        ``"residual"``: refused if its residuals are not small, and with a bound of its error;
        ``"off"``: not looked at, with a certificate that claims nothing.

    Raises
    ------
    StepNotSolved
        If a residual is above ``RESIDUAL_LIMIT`` or not a number.
    """
    delta_q, lam = from_natural(answer.delta_q, answer.lam, scaled.units)
    certificate = NOTHING_CLAIMED
    if certify != "off":
        certificate = _judged(scaled, solver, answer, delta_q, lam)
    return step_solution(scaled.step, delta_q, lam, certificate, answer.statistics)


def _judged(
    scaled: NaturalStep, solver: Solver, answer: Answer, delta_q: Array, lam: Array
) -> Certificate:
    """The residuals of an answer as it is given, in SI units, and a bound of its error."""
    check_arithmetic()
    x, y = in_natural(delta_q, lam, scaled.units)  # SI units may have rounded them: subnormals
    residuals = scaled.residuals(x, y)
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {answer.statistics.status}, but its worst residual is {worst}"
        accuracy = answer.statistics.accuracy
        raise StepNotSolved(solver.name, status, scaled.step, accuracy, residuals)
    error = solver.error_bound(scaled, delta_q, lam)
    useful = error if error <= WORTHLESS else None
    return Certificate("residual", dict(vars(residuals)), error_bound=useful, step=scaled.step)
