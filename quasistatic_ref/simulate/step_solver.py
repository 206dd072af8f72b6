"""How the steps of a run are solved."""

from __future__ import annotations

from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.engines import (
    CVXPY,
    check_solver,
    default_backend,
    default_engine,
    may_be_sparse,
    solver_for,
)
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.solution import StepSolution


class StepSolver:
    """One way of solving all steps of a run, with the solver that is kept between them.

    Parameters
    ----------
    backend : str or None
        Name of a backend, as for :func:`~quasistatic_ref.solve.solve.solve_step`; None is that of
        :func:`~quasistatic_ref.solve.engines.default_backend`, and for extensions that are more
        than rows that of ``solve_step``.
    engine : str or None
        As in :func:`~quasistatic_ref.solve.engines.solver_for`; None is ``"native"`` where that
        reaches the backend and the cone, and ``"cvxpy"`` for extensions that are more than rows.
    accuracy : float
        Asked of the backend, in natural units [-].
    certify : str
        As for ``solve_step``.
    cone : str
        Friction cone of the steps.
    """

    def __init__(
        self, backend: str | None, engine: str | None, accuracy: float, certify: str, cone: str
    ) -> None:
        self.named, self.asked, self.accuracy, self.certify = backend, engine, accuracy, certify
        self.backend = default_backend(engine, cone, certify) if backend is None else backend
        self.engine = default_engine(self.backend, cone) if engine is None else engine
        check_solver(self.backend, self.engine, cone)
        self.kept: Solver | None = None

    @property
    def takes_blocks(self) -> bool:
        """Whether it solves steps whose contacts are in blocks as they are."""
        return may_be_sparse(self.engine, self.backend, self.certify)

    def solution(self, step: StepData, extension: Extension | None = None) -> StepSolution:
        """The step solved, perhaps with an extension that is more than rows."""
        if self.kept is None or not self.kept.fits(step):
            self.kept = solver_for(step, self.backend, self.engine)
        by_name = extension is not None and (self.asked or CVXPY) == CVXPY
        return solve_step(
            step,
            (self.named or DEFAULT) if by_name else self.kept,
            accuracy=self.accuracy,
            certify=self.certify,
            extension=extension,
        )
