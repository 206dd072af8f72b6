"""Steps of a system, solved: by the solver that is kept, and by another one where it fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.groups import flat_rows
from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.step_maker import StepMaker
from quasistatic_ref.solve.backends import DAQP, DEFAULT, NONE, spares
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solution_of, solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import ExtensionOfQ, StepExtension
from quasistatic_ref.step.solution import StepSolution

CoulombSolution = Callable[[StepData, Solver, float], StepSolution]
"""A step, its solver and the accuracy [-] -> its solution under Coulomb's law."""
ExtendedSolution = Callable[["StepSolver", StepData, StepExtension], StepSolution]
"""What solves steps, one of them and what a user adds -> its solution."""


class StepSolver(StepMaker):
    """Makes the problems of steps, and solves them by a solver that serves many."""

    replaceable: ClassVar[tuple[str, ...]] = (DEFAULT, DAQP)

    extension: ExtensionOfQ | None
    named_backend: str | None
    solver: Solver | None = None
    working_set: tuple[int, ...] = ()

    @cached_property
    def spares(self) -> dict[str, Solver]:
        """Solvers that have replaced one that failed, by the names of their backends."""
        return {}

    def start_cold(self) -> None:
        """Forget all that answers of later steps could depend on."""
        self.working_set = ()
        if self.solver is not None and self.solver.remembers:
            self.solver = None

    def extended(self, step: StepData, q: Array) -> StepSolution:
        """Solve a step, with the user's own constraints and costs at q (n_q,), if there are any."""
        if self.extension is None:
            return self.solution(step)
        extended_solution: ExtendedSolution = part("extended_solution")
        return extended_solution(self, step, self.extension(q))

    def fitting_solver(self, step: StepData) -> Solver:
        """The solver of the last step if it fits this step, else a new one."""
        if self.solver is None or not self.solver.fits(step):
            self.solver = solver_for(step, self.backend)
        return self.solver

    def solution(self, step: StepData) -> StepSolution:
        """Solve a step under the simulator's law of friction, by the solver that is kept."""
        solver = self.fitting_solver(step)
        if self.law == COULOMB:
            coulomb_solution: CoulombSolution = part("coulomb")
            return coulomb_solution(step, solver, self.accuracy)
        try:
            return self.solved(self.scaled(step), solver)
        except StepNotSolved as failure:
            return self.otherwise_solved(step, failure)

    def solved(self, scaled: ScaledStep, solver: Solver) -> StepSolution:
        """The solution of a scaled step by a given solver; raises the errors of ``solve_step``."""
        solution = without_warnings(
            solution_of, scaled, solver, self.accuracy, self.certify, self.working_set
        )
        if self.backend == NONE:
            self.working_set = flat_rows(scaled.step, solution.certificate.active)
        return solution

    def otherwise_solved(self, step: StepData, failure: StepNotSolved) -> StepSolution:
        """Solve a step on which the backend failed: by another backend, or by the exact method.

        Its ``statistics.unanswered`` counts such steps. A backend that was asked for by name is
        replaced with ``"residual"`` only, unless it is a default one: ``"full"`` needs none, and
        ``"off"`` is a question to that backend.

        Raises
        ------
        StepNotSolved
            The `failure`, if it is a proof, or is not to be mended.
        """
        replaced = self.certify == "residual" or self.backend in self.replaceable
        if type(failure) is not StepNotSolved or not replaced:
            raise failure
        for name in spares(self.backend, self.cone, "infeasible" in failure.status):
            certify = "full" if name == NONE else self.certify
            try:
                spare = self.spares.get(name)
                if spare is None or not spare.fits(step):
                    spare = solver_for(step, name)
                    if name != NONE:  # it starts cold
                        self.spares[name] = spare
                solution = solve_step(step, spare, accuracy=self.accuracy, certify=certify)
            except StepNotSolved as another:
                if type(another) is not StepNotSolved:  # a proof
                    raise
                continue
            statistics = replace(solution.statistics, unanswered=True)
            return replace(solution, statistics=statistics)
        raise failure
