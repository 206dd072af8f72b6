"""The simulator of `fast`: the same steps, with what can be kept between them."""

from typing import Any

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.optional.fast.backends import (
    default_backend,
    entries_of_J,
    fast_backend,
    sparse_from,
)
from quasistatic_ref.optional.fast.compiled import compiled
from quasistatic_ref.optional.fast.geometry import PosedGeometry
from quasistatic_ref.optional.fast.posed import constants, posed
from quasistatic_ref.optional.fast.tracker.tracker import ContactTracker
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator, by_one_thread
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver, solver_for
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.data import Array, StepData


class FastSimulator(Simulator):
    """As :class:`~quasistatic_ref.simulate.simulator.Simulator`, in less time.

    It keeps which points of the clouds may come among the closest, and poses steps that are right
    by construction, without checking each number. If its default backend, named or not, fails at a
    step that is not certified in full, Clarabel solves the step.

    Parameters
    ----------
    system, pairs, settings
        As of a Simulator.

    Attributes
    ----------
    spare : Solver or None
        A second solver, Clarabel's, once it was needed.
    compiled : CompiledStep or None
        :meth:`step` in compiled code, with the same bits; None if there is none for this simulator.
    """

    geometry: Any  # PosedGeometry, or BlockGeometry of a large scene

    def usable_backend(self) -> str:
        """The backend that was named, or the default of this scene; BackendError as in the base."""
        return fast_backend(self.named_backend, self.cone, self.certify, self.entries())

    def entries(self) -> int:
        """Entries of a step's dense J, 4 n_c n_v, where its contacts may be in blocks; else 0."""
        ordinary = self.extension is None and self.law == CONVEX
        return entries_of_J(self.system, len(self.layout.rows), ordinary)

    def prepare(self) -> None:
        """Check and form what all steps have in common."""
        system = self.system
        entries = self.entries()
        self.default_backend = default_backend(self.cone, self.certify, entries)
        self.spare: Solver | None = None
        self.tracker = ContactTracker(self.pairs)
        least = sparse_from(self.backend, self.cone) if entries else 0
        large = part("large.sparse_jacobian")
        if large is not None and 0 < least <= entries:
            self.geometry = large.BlockGeometry(self.layout, system.column_map)
        else:
            self.geometry = PosedGeometry(self.layout, system.column_map)
        M_u = system.mass_blocks if self.geometry.in_blocks else system.M_u(system.q_start)
        rows = self.layout.rows
        self.constant = constants(self.h, self.K_q, system.n_a, M_u, rows, self.cone)
        in_c = compiled("step")
        self.compiled: Any = None if in_c is None else in_c.compiled_step(self)

    @by_one_thread
    def step(self, q: Array, q_bar_a: Array, force: Array | float = 0.0) -> StepResult:
        """One step, as in the base; by compiled code where that takes it, with the same numbers."""
        if self.compiled is not None:
            taken: StepResult | None = self.compiled(self, q, q_bar_a, force)
            if taken is not None:
                return taken
        return super().step(q, q_bar_a, force)

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, as in the base."""
        return self.tracker.closest_points(kinematics.R, kinematics.t)

    def step_data(
        self,
        q: Array,
        q_bar_a: Array,
        force: Array | float,
        points: ClosestPoints,
        kinematics: Kinematics,
    ) -> StepData:
        """The problem of one step, as in the base, not checked number by number."""
        system = self.system
        n_a = self.system.n_a
        contacts = self.geometry.contacts(points, kinematics)
        delta_q_bar_a = system.actuated_difference(q, q_bar_a)
        tau = self.generalised_force(q, force)
        constant = self.constant if system.constant_mass_matrix else self.constant.at(system.M_u(q))
        loads = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": delta_q_bar_a}
        for array in loads.values():
            read_only(array)
        return posed(constant.kind, constant._asdict(), {**loads, "contacts": contacts})

    def solution(self, step: StepData) -> StepSolution:
        """A step solved; where the default backend fails, by Clarabel."""
        try:
            return super().solution(step)
        except StepNotSolved as failure:
            return self.by_clarabel(step, failure)

    def by_clarabel(self, step: StepData, failure: StepNotSolved) -> StepSolution:
        """Clarabel's answer to a step on which the default backend has failed.

        With ``"full"`` in a polyhedral cone the exact method needs no backend: none fails there.

        Raises
        ------
        StepNotSolved
            The `failure` itself, if another backend than the default failed, or both did.
        """
        of_default = type(failure) is StepNotSolved and failure.backend == self.default_backend
        if not of_default or self.default_backend == DEFAULT:
            raise failure
        if self.spare is None or not self.spare.fits(step):
            self.spare = solver_for(step, DEFAULT, fast=True)
        try:
            return solve_step(step, self.spare, accuracy=self.accuracy, certify=self.certify)
        except StepNotSolved:
            raise failure from None
