"""A simulator's step in compiled code: the same algorithm, the same numbers to the last bit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.fast.library import library
from quasistatic_ref.fast.natural import MOST, NaturalProgram
from quasistatic_ref.fast.poses import Poses
from quasistatic_ref.fast.products import products
from quasistatic_ref.fast.scene import Scene, known
from quasistatic_ref.fast.screws import Screws
from quasistatic_ref.plain import bits
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.stopwatch import Stopwatch
from quasistatic_ref.solve.adapters.program import Program
from quasistatic_ref.solve.native import NativeSolver
from quasistatic_ref.solve.solve import solved
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.posed import PosedContacts, PosedStep
from quasistatic_ref.step.standard_form import StandardForm, standard_form

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import Simulator

SURELY = 1 - 2.0**-40
"""For the rounding of a sum of squares, of 2^-53 of each."""


def taken_by(simulator: Simulator) -> str:
    """What takes a simulator's steps, in words."""
    if (reason := unknown(simulator)) is not None:
        return f"NumPy: {reason}"
    names = ", ".join(dict.fromkeys(measured_by_numpy(simulator)))
    return "compiled code" + (f"; closest points by NumPy, which {names} need" if names else "")


def unknown(simulator: Simulator) -> str | None:
    """Why compiled code does not take a simulator's steps, in words; None if it does."""
    if simulator.engine != "native":
        return f"the engine is {simulator.engine!r}"
    if simulator.extension is not None:
        return "the scene has an extension"
    if not cone(simulator.cone).polyhedral:
        return f"the {simulator.cone} has no rows"
    if not simulator.pairs:
        return "nothing can touch"
    if not isinstance(simulator.geometry, ContactGeometry):
        return "contacts are handed over in blocks"
    if products() is None:
        return "NumPy multiplies matrices here in an order that is not known"
    return None


def measured_by_numpy(simulator: Simulator) -> list[str]:
    """Names of the pairs whose closest points compiled code does not know."""
    return [
        pair.name
        for pair in simulator.pairs
        if not (pair.has_cloud and (known(pair.alpha.shape) or known(pair.beta.shape)))
    ]


def compiled_step(simulator: Simulator) -> CompiledStep | None:
    """What takes a simulator's steps, or None: :func:`unknown` says why."""
    return CompiledStep(simulator) if unknown(simulator) is None else None


class CompiledStep:
    """The step of one simulator.

    The first step's numbers are formed by NumPy, too, and compared.

    Parameters
    ----------
    simulator : Simulator
    """

    def __init__(self, simulator: Simulator) -> None:
        assert isinstance(simulator.geometry, ContactGeometry)
        self.poses, self.geometry = Poses(simulator.system), simulator.geometry
        clouds = None if measured_by_numpy(simulator) else simulator.tracker.clouds
        constant, weighs = simulator.constant, simulator.gravity_acts
        self.scene = Scene(self.poses, self.geometry, constant, weighs, clouds)
        found = library()
        self.find, self.form, self.reach = found.closest_points, found.step_data, found.reach
        self.screws = Screws(simulator.system)
        self.program: NaturalProgram | None = None
        self.equal: bool | None = None

    def __call__(
        self, simulator: Simulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> StepResult | None:
        """The step of :meth:`~quasistatic_ref.simulate.simulator.Simulator.step`.

        Returns
        -------
        StepResult or None
            None where NumPy turns out to multiply otherwise here, or has an extension to take or a
            force to refuse.
        """
        shapes = () if isinstance(force, float) else np.shape(force), self.scene["force"].shape
        if simulator.extension is not None or shapes[0] not in ((), shapes[1]):
            return None
        lap, system = Stopwatch(), simulator.system
        q = np.asarray(q, dtype=np.float64)
        self.poses.move(q)
        self.find_points(simulator, q)
        lap("distances")
        points, step, form = self.step_data(simulator, q, q_bar_a, force)
        if self.equal is None:
            self.equal = bits(form) == bits(self.by_numpy(simulator, q, q_bar_a, force))
            if not self.equal:
                simulator.fast = None
                return None
        lap("rows")
        solver, asked = simulator.fitting(step), (simulator.accuracy, simulator.certify)
        try:
            solution = solved(step, solver, *asked, form, self.units(solver, step))  # Eq. (13)
        except StepNotSolved as failure:
            solution = simulator.spare.answer(step, failure)
        simulator.limits.check_penetration(step)
        lap("solve")
        q_next = self.screws.integrate(q, solution.delta_q)
        self.poses.move(q_next)
        if not self.reach(self.scene.address) <= SURELY * simulator.limits.reach**2:
            simulator.limits.check_reach(step, system.links, system.kinematics(q_next).t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, lap.seconds)

    def find_points(self, simulator: Simulator, q: Array) -> None:
        """Write the closest points at q: from the short lists; NumPy's where these prove none."""
        scene = self.scene
        scene.relist()
        if scene.clouds is not None and scene.listed and self.find(scene.address):
            scene.clouds.steps += 1
            return
        kinematics = simulator.system.kinematics(q)
        points = simulator.tracker.closest_points(kinematics.R, kinematics.t)
        for name, values in points._asdict().items():
            scene[name][:] = values

    def step_data(
        self, simulator: Simulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> tuple[ClosestPoints, StepData, StandardForm]:
        """The closest points and the problem of one step, and its matrices until the next."""
        scene, constant = self.scene, simulator.constant.at(simulator.system.M_u(q))
        delta_q_bar_a = self.screws.actuated_difference(q, q_bar_a)
        np.matmul(constant.K_q, delta_q_bar_a, out=scene["tau_k"])  # in BLAS's order
        self.poses.weigh(q, simulator.gravity)
        scene["force"][:] = force
        self.form(scene.address)
        of, layout, mu = scene.taken(), self.geometry.layout, self.geometry.mu
        points = ClosestPoints(*(of[name] for name in ClosestPoints._fields))
        names = self.geometry.names(points.point)
        frames = points.n, of["d1"], of["d2"], of["J"]
        of_layout = layout.mu_v, layout.mu_omega, layout.rows, mu
        contacts = PosedContacts(names, points.phi, *frames, *of_layout)
        n_a, tau = len(delta_q_bar_a), of["tau"]
        step = PosedStep(constant, tau[:n_a], tau[n_a:], delta_q_bar_a, contacts)
        return points, step, StandardForm(step.H, of["g"], scene["A"], scene["b"])

    def units(self, solver: Solver, step: StepData) -> Units | None:
        """The natural units of the step, where its program is written for the solver in them."""
        if not isinstance(solver, NativeSolver) or not isinstance(solver.program, Program):
            return None
        metric, program = solver.metric, self.program
        if metric is None or metric.H is not step.H or step.n_v > MOST:
            return None
        if program is None or not program.fits(solver):
            self.program = program = NaturalProgram(self.scene, solver.program, metric)
        return program.written(solver)

    def by_numpy(
        self, simulator: Simulator, q: Array, q_bar_a: Array, force: Array | float
    ) -> StandardForm:
        """The matrices of the same step without compiled code."""
        kinematics = simulator.system.kinematics(q)
        points = simulator.tracker.closest_points(kinematics.R, kinematics.t)
        return standard_form(simulator.step_data(q, q_bar_a, force, points, kinematics))
