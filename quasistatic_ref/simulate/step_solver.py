"""How the steps of a run are solved."""

from __future__ import annotations

from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.engines import CVXPY, check_engine, default_engine
from quasistatic_ref.solve.problems import Problem, may_be_sparse, problem_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.solution import StepSolution


class StepSolver:
    """One way of solving all steps of a run, with what the solver keeps between them.

    Parameters
    ----------
    backend : str
        As for :func:`~quasistatic_ref.solve.solve.solve_step`.
    engine : str or None
        As there; None is ``"native"`` where that reaches the backend and the cone, and ``"cvxpy"``
        for extensions that are more than rows.
    accuracy : float
        Asked of the backend, in natural units [-].
    certify : str
    cone : str
        Friction cone of the steps.
    """

    def __init__(
        self, backend: str, engine: str | None, accuracy: float, certify: str, cone: str
    ) -> None:
        self.backend, self.asked, self.accuracy, self.certify = backend, engine, accuracy, certify
        self.engine = default_engine(backend, cone) if engine is None else engine
        check_engine(self.engine)
        self.problem: Problem | None = None

    @property
    def takes_blocks(self) -> bool:
        """Whether it solves steps whose contacts are in blocks as they are."""
        return may_be_sparse(self.engine, self.backend, self.certify)

    def solution(self, step: StepData, extension: Extension | None = None) -> StepSolution:
        """The step solved, perhaps with an extension that is more than rows."""
        if self.backend != NONE and (self.problem is None or not self.problem.fits(step)):
            self.problem = problem_for(step, self.engine, self.backend)
        return solve_step(
            step,
            self.backend,
            engine=self.engine if extension is None else self.asked or CVXPY,
            accuracy=self.accuracy,
            certify=self.certify,
            problem=self.problem,
            extension=extension,
        )
