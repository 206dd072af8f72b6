"""The simulator of `fast`: the same steps, with their data from compiled code."""

from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.formats.given import arguments_checked
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.coordinates import with_shape
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.optional.between import BLOCK_COLUMNS, BlockColumns
from quasistatic_ref.optional.fast.backends import (
    default_backend,
    entries_of_J,
    fast_backend,
    sparse_from,
)
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.natural import NaturalProgram, natural_program
from quasistatic_ref.optional.fast.compiled.pairs import Pairs
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.scene import Columns, Scene, every_column
from quasistatic_ref.optional.fast.compiled.screws import Screws
from quasistatic_ref.optional.fast.posed import Constants, constants, posed
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.optional.fast.sparse_solver import SparseSolver
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.settings import FAST_BACKEND
from quasistatic_ref.simulate.simulator import (
    FAST_SIMULATOR,
    Simulator,
    Stopwatch,
    by_one_thread,
)
from quasistatic_ref.simulate.user_functions import checked_force
from quasistatic_ref.solve.solve import solved
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    HessianInBothUnits,
    StepInBothUnits,
    Units,
)
from quasistatic_ref.step.arrays import finite, read_only, without_warnings
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import Contacts, friction_coefficients
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form

TAKEN = itemgetter(*ClosestPoints._fields, "d1", "d2", "J", "tau")
"""The fields of a step among those that C has written."""

TRIED = 2.0**-10
"""By which sums are tried [m, rad]."""

SURELY = 1 - 2.0**-40
"""Factor that covers the rounding of a sum of squares, each of which is rounded by 2^-53."""


class FastSimulator(Simulator):
    """As :class:`~quasistatic_ref.simulate.simulator.Simulator`, in less time.

    Closest points, J, the data of a step and its standard form come from compiled code, in every
    scene; contacts of pairs and sums of joints that it does not know are those of the plain path.
    The numbers are right by construction, and not checked one by one. Those of the first step (of
    a sparse one only q+) are compared with those of the plain path, which takes all steps if they
    differ. If the
    default backend, named or not, fails at a step that is not proved, Clarabel solves the step.

    Parameters
    ----------
    system, pairs, settings
        As of a Simulator.

    Attributes
    ----------
    compares : bool
        Whether the next step is the first, which is compared.
    by_c : bool
        Whether compiled code takes the steps.
    """

    def prepare(self) -> None:
        """Check and form what all steps have in common."""
        system = self.system
        layout = self.layout
        self.has_rows = cone(self.cone).polyhedral
        ordinary = self.extension is None and self.law == CONVEX and self.has_rows
        entries = entries_of_J(system, self.pairs, ordinary)
        self.default_backend = default_backend(self.cone, self.certify, entries)
        least = sparse_from(self.backend, self.cone)
        block_columns = BLOCK_COLUMNS.found() if 0 < least <= entries.every else None
        self.blocks: BlockColumns | None = None
        if block_columns is None:
            columns = every_column(self.geometry)
            M_u = system.M_u(system.q_start)
        else:
            self.blocks = kept = block_columns(layout, system.column_map)
            columns = Columns(*kept.columns())
            M_u = system.mass_blocks
        self.constant = constants(self.h, self.K_q, system.n_a, M_u, layout.rows, self.cone)
        self.same = self.constant.fields()
        mu = friction_coefficients(layout.mu_v, layout.mu_omega, layout.rows)
        self.friction = {"mu_v": layout.mu_v, "mu_omega": layout.mu_omega,
                         "rows": layout.rows, "mu": mu}  # fmt: skip
        self.poses = Poses(system)
        self.down = tuple(self.gravity.tolist())
        self.numbers = Scene(self.poses, columns, self.constant, mu, self.gravity_factor)
        self.given = self.numbers["force"]
        self.target = self.numbers["delta_q_bar_a"]
        self.contacts = Pairs(self.pairs, self.poses.R, self.poses.t, self.numbers.points)
        self.screws = Screws(system, self.poses)
        compiled = library()
        self.form = compiled.step_data
        self.squared_distances = compiled.squared_distances
        self.compares = True
        self.by_c = True
        self.named: tuple[list[int], tuple[str, ...]] = [], ()
        self.fitted: Solver | None = None
        self.hessian: HessianInBothUnits | None = None
        self.program: NaturalProgram | None = None
        self.surely_within = SURELY * self.limits.reach**2

    @arguments_checked
    @by_one_thread
    def step(self, q: Array, q_bar_a: Array, force: Array | float = 0.0) -> StepResult:
        """One step, as in the base."""
        if not self.by_c:
            return super().step(q, q_bar_a, force)
        q = with_shape(q, "q", (self.system.n_q,))
        q_bar_a = with_shape(q_bar_a, "q_a", (self.system.n_q_a,))
        self.system.actuated_units.check(q_bar_a)
        if not self.poses.are_at(q):  # where a step has led, or which was checked
            self.system.units.check(q)
            self.poses.move(q)
        if self.compares:
            self.compares = False
            self.by_c = self.is_plain(q, q_bar_a, force)
            if not self.by_c:
                return super().step(q, q_bar_a, force)
        if np.shape(force) != self.given.shape:
            force = checked_force(self.system, force) + np.zeros(self.system.n_v)
        tau = np.asarray(force)
        return self.posed_result(q, q_bar_a, tau)

    def posed_result(self, q: Array, q_bar_a: Array, force: Array) -> StepResult:
        """One step from the checked q, whose poses are there."""
        lap = Stopwatch()
        self.contacts.find(self.poses)
        lap("distances")
        step, form, points = self.posed_step(q_bar_a, force)
        lap("rows")
        solution = self.solution_of(step, form, q)
        if not self.gap >= -self.limits.penetration:
            self.limits.check_penetration(step)
        step = solution.step
        lap("solve")
        lap.separate("proof", solution.statistics.proof_time, "solve")
        q_next = self.screws.integrate(solution.delta_q[: self.system.n_v])
        self.poses.move(q_next)
        if not self.squared_distances(self.numbers.address) <= self.surely_within:
            self.limits.check_reach(step, self.system.links, self.poses.kinematics().t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, lap.seconds, q, self.scene)

    def posed_step(
        self, q_bar_a: Array, force: Array | float
    ) -> tuple[StepData, StandardForm, ClosestPoints]:
        """The problem of one step, its matrices and closest points, from those that are written.

        The arrays A and b of the matrices are overwritten by the next step. In blocks, A has those
        columns only; in a curved cone A and b are empty. StepDataError if the force has another
        shape.
        """
        numbers = self.numbers
        if np.shape(force) != self.given.shape:
            force = checked_force(self.system, force)
        self.given[:] = force
        delta_q_bar_a = self.screws.actuated_difference(q_bar_a)
        self.target[:] = delta_q_bar_a
        delta_q_bar_a.setflags(write=False)
        self.poses.weigh(self.down)
        self.gap = self.form(numbers.address)
        taken = numbers.taken()
        step, points = self.step_of(taken, delta_q_bar_a)
        return step, StandardForm(self.constant.H, taken["g"], numbers["A"], numbers["b"]), points

    def step_of(
        self, written: NDArray[np.void], delta_q_bar_a: Array
    ) -> tuple[StepData, ClosestPoints]:
        """The problem of a step and its closest points, from what C has written of it.

        Parameters
        ----------
        written : ndarray, shape ()
            As of :meth:`~quasistatic_ref.optional.fast.compiled.scene.Scene.taken`, in
            its units [any unit].
        delta_q_bar_a : ndarray, shape (n_a,)
            [m, rad].
        """
        *found, d1, d2, J, tau = TAKEN(written)
        points = ClosestPoints(*found)
        contacts = self.posed_contacts(points, d1, d2, J)
        return self.posed_data(tau, delta_q_bar_a, contacts), points

    def step_under(self, q: Array, q_bar_a: Array, tau: Array, contacts: Contacts) -> StepData:
        """As in the base, with the H that all steps share.

        A backend that starts warm keeps what it made of H: a run that is resumed asks it for steps
        of this function, and must end with the bits of one that was not.
        """
        own = self.constant.kind is not StepData or self.system.varying_mass is not None
        change = read_only(self.system.actuated_difference(q, q_bar_a) + 0.0)
        if own or not (finite(tau) and finite(change)):
            return super().step_under(q, q_bar_a, tau, contacts)
        return self.posed_data(read_only(tau + 0.0), change, contacts)

    def posed_data(self, tau: Array, delta_q_bar_a: Array, contacts: Contacts) -> StepData:
        """A step at the poses, from tau (n_v,) [N, N m] and its own read-only arrays."""
        constant = self.constant_here()
        n_a = len(delta_q_bar_a)
        own: dict[str, object] = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "contacts": contacts}
        own["delta_q_bar_a"] = delta_q_bar_a
        return posed(constant.kind, self.same, own)

    def contacts_at(self, points: ClosestPoints, kinematics: Kinematics) -> Contacts:
        """As in the base."""
        if self.blocks is not None:
            return super().contacts_at(points, kinematics)
        d1, d2, *_ = map(read_only, (*tangents(points.n), points.phi, points.n))
        J = self.geometry.jacobian(kinematics.columns, points.alpha, points.beta, points.n)
        return self.posed_contacts(points, d1, d2, read_only(J))

    def constant_here(self) -> Constants:
        """What steps have in common, with M_u at the poses; StepDataError if it is not definite."""
        mass = self.system.varying_mass
        if mass is not None:
            constant = self.constant.at(mass.at(self.poses.kinematics()))
            if constant is not self.constant:
                self.constant = constant
                self.same = constant.fields()
                self.fitted = None
        return self.constant

    def posed_contacts(self, points: ClosestPoints, d1: Array, d2: Array, J: Array) -> Contacts:
        """The contacts at those points, from d1, d2 (n_c, 3) [-], J (n_c, 4, ...) [m, rad]."""
        layout = self.layout
        listed = points.point.tolist()
        named = self.named  # another thread may read a result
        if listed != named[0]:
            self.named = named = listed, layout.contact_names(points.point)
        name = named[1]
        if self.blocks is not None:
            return self.blocks.contacts(layout, name, points, d1, d2, J)
        own = {"name": name, "phi": points.phi, "n": points.n, "d1": d1, "d2": d2, "J": J}
        return posed(Contacts, self.friction, own)

    def is_plain(self, q: Array, q_bar_a: Array, force: Array | float) -> bool:
        """Whether the numbers of the step from q, its matrices and a sum are the plain path's.

        Of a sparse step, only the sum is compared.
        """
        self.contacts.find(self.poses)
        step, form, _ = self.posed_step(q_bar_a, force)
        delta_q = TRIED * np.arange(1.0, self.system.n_v + 1)
        if bits(self.screws.integrate(delta_q)) != bits(self.system.integrate(q, delta_q)):
            return False
        if self.blocks is not None:
            return True
        kinematics = self.system.kinematics(q)
        points = self.closest_points(kinematics)
        contacts = self.geometry.contacts(points, kinematics)
        plain = super().step_under(q, q_bar_a, self.generalised_force(q, force), contacts)
        return plain == step and (not self.has_rows or bits(form) == bits(standard_form(plain)))

    def solution_of(self, step: StepData, form: StandardForm, q: Array) -> StepSolution:
        """The solution of a step from q whose matrices are there; errors as of the base's step."""
        if self.extension is not None:
            return self.extended(step, q)
        if self.law != CONVEX or not self.has_rows:
            return self.solution(step)
        try:
            return self.solution_from(step, form)
        except StepNotSolved as failure:
            return self.otherwise_solved(step, failure)

    def solution_from(self, step: StepData, form: StandardForm) -> StepSolution:
        """The solution of the step whose matrices are there; StepNotSolved if there is none."""
        solver = self.solver
        if solver is None or solver is not self.fitted:  # what fits one step fits all of them
            self.fitted = solver = self.fitting_solver(step)
        both = self.in_both_units(step, form, solver)
        return without_warnings(solved, both, solver, self.accuracy, self.certify)

    def in_both_units(self, step: StepData, form: StandardForm, solver: Solver) -> StepInBothUnits:
        """The step whose matrices are there, in both units, with what H gives of them kept."""
        if isinstance(solver, SparseSolver):
            return without_warnings(solver.from_blocks, step, form)
        units = None
        hessian = self.hessian
        if isinstance(solver, FastSolver):
            units = self.units(solver, step)
            hessian = solver.hessian or hessian
        both = without_warnings(DenseStepInBothUnits, step, hessian, form, units)
        self.hessian = both.hessian
        return both

    def units(self, solver: FastSolver, step: StepData) -> Units | None:
        """The natural units in which the program of the step is written; None if it is not."""
        program = self.program
        if program is None or not program.fits(solver, step):
            self.program = program = natural_program(self.numbers, solver, step)
        return None if program is None else program.written()


FAST_SIMULATOR.fill(FastSimulator)
FAST_BACKEND.fill(
    lambda name, system, pairs, cone, certify, ordinary: fast_backend(
        name, cone, certify, entries_of_J(system, pairs, ordinary) if name is None else None
    )
)
