"""A simulator's step in compiled code: the same algorithm, the same numbers to the last bit."""

from __future__ import annotations

from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.distance import ClosestPoints, closest_points
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.fast.compiled.answer import as_said
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.natural import NaturalProgram, natural_program
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.scene import Scene
from quasistatic_ref.optional.fast.compiled.screws import Screws
from quasistatic_ref.optional.fast.compiled.solids import measured
from quasistatic_ref.optional.fast.geometry import PosedGeometry
from quasistatic_ref.optional.fast.kept_step import KeptStepInBothUnits
from quasistatic_ref.optional.fast.native import native_backends
from quasistatic_ref.optional.fast.posed import Constants, PosedStep, posed
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Stopwatch
from quasistatic_ref.solve.solve import solved
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.arrays import without_warnings
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form

if TYPE_CHECKING:
    from quasistatic_ref.optional.fast.simulator import FastSimulator

WRITTEN = ClosestPoints._fields
TAKEN = itemgetter(*WRITTEN, "d1", "d2", "J", "tau", "g")
"""The fields of a step among those that C has written."""

SURELY = 1 - 2.0**-40
"""Factor that covers the rounding of a sum of squares, each of which is rounded by 2^-53."""


def taken_by(simulator: FastSimulator) -> str:
    """What takes a simulator's steps, in words."""
    if (reason := unknown(simulator)) is not None:
        return f"NumPy: {reason}"
    names = ", ".join(dict.fromkeys(measured_by_numpy(simulator)))
    return "compiled code" + (f"; closest points by NumPy, which {names} need" if names else "")


def unknown(simulator: FastSimulator) -> str | None:
    """Why compiled code does not take a simulator's steps, in words; None if it does."""
    if simulator.backend not in native_backends(simulator.cone):
        return f"{simulator.backend!r} has no interface of its own here"
    if simulator.extension is not None:
        return "the scene has an extension"
    if simulator.law != CONVEX:
        return f"the law is {simulator.law}"
    if not cone(simulator.cone).polyhedral:
        return f"the {simulator.cone} has no rows"
    if not simulator.pairs:
        return "nothing can touch"
    if not isinstance(simulator.geometry, PosedGeometry):
        return "contacts are handed over in blocks"
    return None


def measured_by_numpy(simulator: FastSimulator) -> list[str]:
    """Names of the pairs whose closest points compiled code does not know."""
    return [pair.name for pair in simulator.pairs if not measured(pair)]


def compiled_step(simulator: FastSimulator) -> CompiledStep | None:
    """What takes a simulator's steps, or None: :func:`unknown` says why."""
    return CompiledStep(simulator) if unknown(simulator) is None else None


class CompiledStep:
    """The step of one simulator.

    The first step's numbers are formed by NumPy, too, and compared.

    Parameters
    ----------
    simulator : FastSimulator
    """

    def __init__(self, simulator: FastSimulator) -> None:
        assert isinstance(simulator.geometry, PosedGeometry)
        self.poses = Poses(simulator.system)
        self.geometry = simulator.geometry
        tracker = None if measured_by_numpy(simulator) else simulator.tracker
        constant = simulator.constant
        weighs = simulator.gravity_factor
        self.scene = Scene(self.poses, self.geometry, constant, weighs, tracker)
        self.force = self.scene["force"]
        self.target = self.scene["delta_q_bar_a"]
        found = library()
        self.find = found.closest_points
        self.form = found.step_data
        self.reach = found.reach
        self.screws = Screws(simulator.system, self.poses)
        self.program: NaturalProgram | None = None
        self.equal: bool | None = None
        self.constant: Constants | None = None
        self.of_steps: dict[str, Any] = {}
        self.solver: FastSolver | None = None

    def __call__(
        self, simulator: FastSimulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> StepResult | None:
        """The step of :meth:`~quasistatic_ref.simulate.simulator.Simulator.step`.

        Returns
        -------
        StepResult or None
            None where NumPy has to take the step: the first step's matrices differ from NumPy's,
            the simulator has an extension, or the force has another shape.
        """
        shape = () if isinstance(force, float) else np.shape(force)
        if simulator.extension is not None or (shape and shape != self.force.shape):
            return None
        lap = Stopwatch()
        system = simulator.system
        q = np.asarray(q, dtype=np.float64)
        self.poses.move(q)
        self.find_points(simulator)
        lap("distances")
        points, step, form, gap = self.step_data(simulator, q, q_bar_a, force)
        if self.equal is None:
            self.equal = bits(form) == bits(self.by_numpy(simulator, q, q_bar_a, force))
            if not self.equal:
                simulator.compiled = simulator.tracker.solids = None
                return None
        lap("rows")
        try:
            solution = self.solution(simulator, step, form)  # Eq. (13)
        except StepNotSolved as failure:
            solution = simulator.by_clarabel(step, failure)
        limits = simulator.limits
        if not gap >= -limits.penetration:
            limits.check_penetration(step)
        lap("solve")
        lap.separate("proof", solution.statistics.proof_time, "solve")
        q_next = self.screws.integrate(solution.delta_q)
        self.poses.move(q_next)
        if not self.reach(self.scene.address) <= SURELY * limits.reach**2:
            limits.check_reach(step, system.links, system.kinematics(q_next).t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, lap.seconds, q, simulator.scene)

    def find_points(self, simulator: FastSimulator) -> None:
        """Write the closest points of the poses; the tracker's where C does not decide them."""
        scene = self.scene
        scene.relist()
        if scene.listed and self.find(scene.address):
            simulator.tracker.steps += 1
            return
        points = simulator.closest_points(self.poses.kinematics())
        for name in WRITTEN:
            scene.fill(name, getattr(points, name))

    def step_data(
        self, simulator: FastSimulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> tuple[ClosestPoints, StepData, StandardForm, float]:
        """The closest points, the problem of one step, its matrices and its least gap [m].

        The arrays A and b of the matrices are overwritten by the next step.
        """
        scene = self.scene
        system = simulator.system
        mass = system.varying_mass
        M_u = system.M_u(q) if mass is None else mass.at(self.poses.kinematics())
        constant = simulator.constant.at(M_u)
        delta_q_bar_a = self.screws.actuated_difference(q_bar_a)
        delta_q_bar_a.setflags(write=False)
        self.target[:] = delta_q_bar_a
        self.poses.weigh(simulator.gravity)
        self.force[:] = force
        gap = self.form(scene.address)
        *found, d1, d2, J, tau, g = TAKEN(scene.taken())
        points = ClosestPoints(*found)
        contacts = self.geometry.posed(points, d1, d2, J)
        if constant is not self.constant:
            self.constant, self.of_steps, self.solver = constant, constant._asdict(), None
        n_a = len(delta_q_bar_a)
        loads = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": delta_q_bar_a}
        step = posed(PosedStep, self.of_steps, {**loads, "contacts": contacts})
        return points, step, StandardForm(constant.H, g, scene["A"], scene["b"]), gap

    def solution(
        self, simulator: FastSimulator, step: StepData, form: StandardForm
    ) -> StepSolution:
        """The solution of the step whose matrices are there; StepNotSolved if there is none."""
        solver = self.solver
        accuracy = simulator.accuracy
        certify = simulator.certify
        if solver is None or solver is not simulator.solver:  # what fits one fits all of them
            found = simulator.fitting_solver(step)
            assert isinstance(found, FastSolver)
            self.solver = solver = found
        units = self.units(solver, step)
        said = as_said(step, solver, units, accuracy) if certify == "off" else None
        if said is not None:
            return said
        both = without_warnings(KeptStepInBothUnits, step, solver.hessian, form, units)
        return without_warnings(solved, both, solver, accuracy, certify)

    def units(self, solver: FastSolver, step: StepData) -> Units | None:
        """The natural units in which the program of the step is written; None if it is not."""
        program = self.program
        if program is None or not program.fits(solver, step):
            self.program = program = natural_program(self.scene, solver, step)
        return None if program is None else program.written()

    def by_numpy(
        self, simulator: FastSimulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> StandardForm:
        """The matrices of the same step without compiled code."""
        kinematics = simulator.system.kinematics(q)
        points = closest_points(simulator.pairs, kinematics)
        return standard_form(simulator.step_data(q, q_bar_a, force, points, kinematics))
