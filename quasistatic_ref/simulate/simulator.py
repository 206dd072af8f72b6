"""The simulator: one step as the algorithm of the paper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.contact.sparse_jacobian import BlockGeometry
from quasistatic_ref.contact.tracker import ContactTracker
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.stopwatch import Stopwatch
from quasistatic_ref.simulate.words import NOT_IN_TEXT, result_page, simulator_page
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.engines import (
    CVXPY,
    check_solver,
    default_engine,
    may_be_sparse,
    solver_for,
)
from quasistatic_ref.solve.extended import extension_rows, with_rows
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.show import html_page, shown, text_page
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import ACCURACY, SPARSE_FROM

GRAVITY = (0.0, 0.0, -9.81)


class StepResult(NamedTuple):
    """Everything that one step came to.

    Parameters
    ----------
    q : ndarray, shape (n_q,)
        Configuration after the step.
    step : StepData
        The problem of the step.
    solution : StepSolution
    points : ClosestPoints
        Where the contacts were, before the step.
    seconds : dict of str to float
        Wall time of the parts: distances, rows, solve, integrate [s].
    """

    q: Array
    step: StepData
    solution: StepSolution
    points: ClosestPoints
    seconds: dict[str, float]

    def __repr__(self) -> str:
        return text_page(result_page(self), *NOT_IN_TEXT)

    def _repr_html_(self) -> str:
        return html_page(result_page(self))


class Simulator:
    """A system, what may touch in it, and how each step is solved.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    h : float
        Time step [s].
    K_q : ndarray, shape (n_a, n_a)
        Joint stiffness [N/m, N m/rad], in the order of q_a.
    gravity : array_like, shape (3,)
        [m/s^2], world frame.
    feels_gravity : ndarray of bool, shape (n_a,), optional
        Actuated coordinates whose gravity is not compensated by the robot; none by default.
    solver : str
        Name of a backend, as in :func:`~quasistatic_ref.solve.solve.solve_step`.
    accuracy, certify
        As there.
    engine : str, optional
        As in :func:`~quasistatic_ref.solve.engines.solver_for`; ``"native"`` by default where that
        reaches the backend and the cone.
    cone : str
        Friction cone of every contact; see :mod:`~quasistatic_ref.step.cones`.
    extension : callable, optional
        q -> constraints and costs of the user's own at q, for every step.
    limits : Limits, optional
        Beyond which no step is taken; by default those of
        :class:`~quasistatic_ref.simulate.limits.Limits`.
    """

    __repr__, _repr_html_ = shown(simulator_page)

    def __init__(
        self,
        system: System,
        pairs: Sequence[ContactPair],
        *,
        h: float,
        K_q: Array,
        gravity: Sequence[float] = GRAVITY,
        feels_gravity: Array | None = None,
        solver: str = DEFAULT,
        engine: str | None = None,
        accuracy: float = ACCURACY,
        certify: str = "full",
        cone: str = PYRAMID,
        extension: Callable[[Array], Extension] | None = None,
        limits: Limits | None = None,
    ) -> None:
        self.system, self.pairs, self.layout = system, tuple(pairs), contact_layout(pairs)
        self.tracker = ContactTracker(self.pairs)
        self.h, self.K_q, self.gravity = h, K_q, np.asarray(gravity, dtype=np.float64)
        self._gravity = tuple(self.gravity.tolist())
        self.weighs = np.ones(system.n_v)
        self.weighs[: system.n_a] = False if feels_gravity is None else feels_gravity
        self.backend, self.accuracy, self.certify = solver, accuracy, certify
        self.cone, self.extension = cone, extension
        self.limits = Limits() if limits is None else limits
        self.engine = default_engine(solver, cone) if engine is None else engine
        check_solver(solver, self.engine, cone)
        self._curved = CVXPY if engine is None else engine  # extensions that are more than rows
        self.solver: Solver | None = None
        large = 4 * len(self.layout.rows) * system.n_v >= SPARSE_FROM
        able = may_be_sparse(self.engine, solver, certify) and extension is None and system.rigid
        geometry = BlockGeometry if large and able else ContactGeometry
        self.geometry = geometry(self.layout, system.motion)
        self._like: StepData | None = None
        self._here: tuple[bytes, Kinematics] | None = None

    def step(self, q: Array, q_bar_a: Array, force: Array | float = 0.0) -> StepResult:
        """One step from q towards the target q_bar_a.

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        q_bar_a : ndarray, shape (n_q_a,)
            Target of the actuated coordinates at the end of the step.
        force : ndarray, shape (n_v,), optional
            External generalised force besides gravity [N, N m].

        Returns
        -------
        StepResult

        Raises
        ------
        StepNotSolved
            If the backend's answer cannot be trusted, the step has no solution, or it
            starts or ends beyond the limits.
        """
        lap = Stopwatch()
        kinematics = self.kinematics(q)
        points = self.tracker.closest_points(kinematics.R, kinematics.t)
        lap("distances")
        step = self.step_data(q, q_bar_a, force, points, kinematics)
        step, own = self.extended(step, q)
        lap("rows")
        solution = self.solved(step, own)
        self.limits.check_penetration(step)  # an infeasible step says more about itself
        lap("solve")
        q_next = self.system.integrate(q, solution.delta_q)  # q (+) delta_q
        self.limits.check_reach(step, self.system.links, self.kinematics(q_next).t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, lap.seconds)

    def kinematics(self, q: Array) -> Kinematics:
        """Poses and Jacobians at q; those of the end of a step serve the next one too."""
        key = np.asarray(q, dtype=np.float64).tobytes()
        if self._here is None or self._here[0] != key:
            self._here = key, self.system.kinematics(q)
        return self._here[1]

    def step_data(
        self,
        q: Array,
        q_bar_a: Array,
        force: Array | float,
        points: ClosestPoints,
        kinematics: Kinematics,
    ) -> StepData:
        """The problem of one step: everything in Eq. :eq:`eq-13` at q."""
        system, n_a = self.system, self.system.n_a
        tau = self.weighs * system.gravity_force(q, self._gravity) + force
        delta_q_bar_a = system.actuated_difference(q, q_bar_a)  # q_bar_a(t + h) (-) q_a
        tau_a, tau_u, M_u, like = tau[:n_a], tau[n_a:], system.M_u(q), self._like
        if like is None or tau.shape != self.weighs.shape:  # checked once, or to say what is wrong
            at = self.geometry.contacts(points, kinematics)
            step = StepData(self.h, self.K_q, M_u, tau_a, tau_u, delta_q_bar_a, at, self.cone)
        else:
            at = self.geometry.contacts(points, kinematics, like.contacts)
            step = like.moved(M_u, tau_a, tau_u, delta_q_bar_a, at)
        self._like = step
        return step

    def extended(self, step: StepData, q: Array) -> tuple[StepData, Extension | None]:
        """The step with the user's rows at q, shape (n_q,), and what is more than rows."""
        own = None if self.extension is None else self.extension(q)
        if own is not None and (rows := extension_rows(step, own)) is not None:
            return with_rows(step, rows), None
        return step, own

    def solved(self, step: StepData, own: Extension | None = None) -> StepSolution:
        """The step solved, by a solver that is made once."""
        if self.solver is None or not self.solver.fits(step):
            self.solver = solver_for(step, self.backend, self.engine)
        return solve_step(
            step,
            self.backend if own is not None and self._curved == CVXPY else self.solver,
            accuracy=self.accuracy,
            certify=self.certify,
            extension=own,
        )
