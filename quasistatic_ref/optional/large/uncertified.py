"""A solver's own answer, judged by its residuals and by a rigorous bound of its error."""

import math

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.solve.scaled import NaturalStep
from quasistatic_ref.solve.solver import Answer, Solver
from quasistatic_ref.solve.units import from_natural
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
    certificate = NOTHING_CLAIMED if certify == "off" else _judged(scaled, solver, answer)
    delta_q, lam = from_natural(answer.delta_q, answer.lam, scaled.units)
    return step_solution(scaled.step, delta_q, lam, certificate, answer.statistics)


def _judged(scaled: NaturalStep, solver: Solver, answer: Answer) -> Certificate:
    """The residuals of a solver's answer, which have to be small, and a bound of its error."""
    residuals = scaled.residuals(answer.delta_q, answer.lam)
    if not residuals.worst <= RESIDUAL_LIMIT:  # NaN fails too
        worst = "NaN" if math.isnan(residuals.worst) else f"{residuals.worst:.1e}"
        status = f"it said {answer.statistics.status}, but its worst residual is {worst}"
        accuracy = answer.statistics.accuracy
        raise StepNotSolved(solver.name, status, scaled.step, accuracy, residuals)
    return Certificate(
        "residual", dict(vars(residuals)), error_bound=solver.error_bound(scaled, answer)
    )
