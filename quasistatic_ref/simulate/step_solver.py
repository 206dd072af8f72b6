"""Steps of a system, solved: by the solver that is kept, and by another one where it fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, wraps
from typing import ClassVar, Concatenate, ParamSpec, TypeVar

from numpy.typing import ArrayLike

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.state import State
from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.distance_source import measured_pairs
from quasistatic_ref.simulate.form_step import StepBlock, StepPlan
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.solve.backends import DAQP, DEFAULT, NONE, fallbacks
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solve import ExactCertificate, solve_step, step_solution
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.extension import ExtensionOfQ, StepExtension
from quasistatic_ref.step.solution import StepSolution

CoulombSolution = Callable[[StepData, Solver, float], StepSolution]
"""A step, its solver and the accuracy [-] -> its solution under Coulomb's law."""
SimulatedSolution = Callable[["StepSolver", StepData, StepExtension], StepSolution]
"""What solves steps, one of them and what a user adds -> its solution."""


P = ParamSpec("P")
T = TypeVar("T")
Method = Callable[Concatenate["StepSolver", P], T]


def in_turn(method: Method[P, T]) -> Method[P, T]:
    """A method that uses the solver that is kept: other threads wait for their turn."""

    @wraps(method)
    def waiting(self: StepSolver, /, *arguments: P.args, **named: P.kwargs) -> T:
        with self.system.lock:
            return method(self, *arguments, **named)

    return waiting


class StepSolver(Settings):
    """Makes the problems of steps, and solves them by a solver that serves many."""

    replaceable: ClassVar[tuple[str, ...]] = (DEFAULT, DAQP)

    extension: ExtensionOfQ | None
    named_backend: str | None
    solver: Solver | None = None
    working_set: tuple[int, ...] = ()

    @cached_property
    def plan(self) -> StepPlan:
        """What its steps have in common."""
        return StepPlan(
            system=self.system,
            pairs=measured_pairs(self.pairs, self.distances),
            h=self.h,
            K_q=self.K_q,
            gravity=self.gravity,
            gravity_acts=self.gravity_acts,
            cone=self.cone,
        )

    def natural_step(self, step: StepData) -> NaturalStep:
        """A step with its program, by the groups of the simulator if it has its structure."""
        plan = self.plan
        if isinstance(step.formed, StepBlock) and plan.group_layout is not None:
            return step.formed.natural(step, plan.group_layout)
        own = step.contacts.column is plan.geometry.column and step.extra.empty
        return NaturalStep(step, layout=plan.group_layout if own else None)

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's in ascending distance.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite.
        """
        return self.plan.all_pairs.closest_points(kinematics)

    def generalised_force(self, q: ArrayLike | State, force: ArrayLike | None) -> Array:
        """Gravity at q plus an external `force`, shape (n_v,) [N, N m]."""
        return self.plan.load(self.system.at(q), force)

    @cached_property
    def fallbacks(self) -> dict[str, Solver]:
        """Solvers that have replaced one that failed, by the names of their backends."""
        return {}

    @in_turn
    def start_cold(self) -> None:
        """Forget all that answers of later steps could depend on."""
        self.working_set = ()
        if self.solver is not None and self.solver.remembers:
            self.solver = None

    @in_turn
    def fitting_solver(self, step: StepData) -> Solver:
        """The solver of the last step if it fits this step, else a new one."""
        if self.solver is None or not self.solver.fits(step):
            self.solver = solver_for(step, self.backend)
        return self.solver

    def solution(
        self,
        step: StepData,
        q: Array | None = None,
        precomputed: tuple[NaturalStep, Solver] | None = None,
    ) -> StepSolution:
        """The solution of a step under the simulator's law of friction.

        Parameters
        ----------
        step : StepData
        q : ndarray, shape (n_q,), optional
            Where the user's own constraints and costs are asked for; left out, none are added.
        precomputed : (NaturalStep, Solver), optional
            The step, and a solver that has its reply; by default the solver that is kept.

        Raises
        ------
        StepNotSolved, StepDataError
            As of ``solve_step``.
        """
        with self.system.lock:  # other threads wait for the solver that is kept
            if self.extension is not None and q is not None:
                simulated_solution: SimulatedSolution = part("simulated_solution")
                return simulated_solution(self, step, self.extension(q))
            natural, solver = precomputed or (self.natural_step(step), self.fitting_solver(step))
            if self.law == COULOMB:
                coulomb_solution: CoulombSolution = part("coulomb")
                return coulomb_solution(step, solver, self.accuracy)
            settings = self.accuracy, self.certify, self.working_set
            try:
                solution = without_warnings(step_solution, natural, solver, *settings)
            except StepNotSolved as failure:
                return self.fallback_solution(step, failure)
            if self.backend == NONE and isinstance(solution.certificate, ExactCertificate):
                self.working_set = solution.certificate.working_set
            return solution

    @in_turn
    def fallback_solution(self, step: StepData, failure: StepNotSolved) -> StepSolution:
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
        for name in fallbacks(self.backend, self.cone, "infeasible" in failure.status):
            certify = "full" if name == NONE else self.certify
            try:
                fallback = self.fallbacks.get(name)
                if fallback is None or not fallback.fits(step):
                    fallback = solver_for(step, name)
                    if name != NONE:  # it starts cold
                        self.fallbacks[name] = fallback
                solution = solve_step(step, fallback, accuracy=self.accuracy, certify=certify)
            except StepNotSolved as another:
                if type(another) is not StepNotSolved:  # a proof
                    raise
                continue
            statistics = replace(solution.statistics, unanswered=True)
            return replace(solution, statistics=statistics)
        raise failure
