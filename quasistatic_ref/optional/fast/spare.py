"""What solves a step on which the default backend of a run fails: Clarabel."""

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver, solver_for
from quasistatic_ref.step.data import StepData


class Spare:
    """A second backend, Clarabel, which is made when it is needed.

    Parameters
    ----------
    default : str
        The default backend of a run with these settings.
    accuracy : float
        In natural units [-].
    certify : str
        As in :func:`~quasistatic_ref.solve.solve.solve_step`. With ``"full"`` in a polyhedral cone
        the exact method needs no backend, and so no second one.
    """

    def __init__(self, default: str, accuracy: float, certify: str) -> None:
        self.default = default
        self.accuracy = accuracy
        self.certify = certify
        self.solver: Solver | None = None

    def answer(self, step: StepData, failure: StepNotSolved) -> StepSolution:
        """The second backend's answer to a step.

        Raises
        ------
        StepNotSolved
            The `failure` itself, if another backend than the default failed, or both backends did.
        """
        of_backend = type(failure) is StepNotSolved and failure.backend == self.default
        if not of_backend or self.default == DEFAULT:
            raise failure
        if self.solver is None or not self.solver.fits(step):
            self.solver = solver_for(step, DEFAULT, fast=True)
        try:
            return solve_step(step, self.solver, accuracy=self.accuracy, certify=self.certify)
        except StepNotSolved:
            raise failure from None
