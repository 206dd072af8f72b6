"""The simulator: one step as the algorithm of the paper."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.compiled import compiled
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.optional.fast.posed import constants
from quasistatic_ref.optional.fast.spare import Spare
from quasistatic_ref.optional.fast.tracker.tracker import ContactTracker
from quasistatic_ref.optional.large.sparse_jacobian import contact_geometry
from quasistatic_ref.parts import needed_part
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.one_thread import by_one_thread
from quasistatic_ref.simulate.result import CompiledStep, StepResult
from quasistatic_ref.simulate.stopwatch import Stopwatch
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.engines import (
    CVXPY,
    check_solver,
    default_backend,
    default_engine,
    solver_for,
    sparse_from,
)
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.contacts import Points
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import ACCURACY

GRAVITY = (0.0, 0.0, -9.81)


def _remade(
    kind: type["Simulator"], system: System, pairs: Sequence[ContactPair], settings: dict[str, Any]
) -> "Simulator":
    """A simulator from what it was made of: the arguments that a deep copy copies."""
    return kind(system, pairs, **settings)


class Simulator(Shown):
    """A system, what may touch in it, and how each step is solved.

    A simulator keeps what is slow to make and serves many steps: which points of the clouds may
    come among the closest, which coordinates move which contact, the solver. A copy is a new
    simulator with the same settings. Simulators of one system are for one thread: a step that is
    asked for while another thread takes one is refused. A deep copy has a system of its own.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    h : float
        Time step [s].
    K_q : ndarray, shape (n_a, n_a)
        Stiffness of the actuated coordinates [N/m, N m/rad], in the order of delta_q.
    gravity : array_like, shape (3,)
        [m/s^2], world frame.
    gravity_acts : ndarray of bool, shape (n_a,), optional
        Whether gravity acts on each actuated coordinate; by default on none, as if the robot
        compensated its own weight.
    solver : str, optional
        Name of a backend; by default that of
        :func:`~quasistatic_ref.solve.engines.default_backend`. If that default, named here or
        not, fails at a step that is not certified in full, Clarabel solves the step. `solver`,
        `accuracy` and `certify` are otherwise as in
        :func:`~quasistatic_ref.solve.solve.solve_step`.
    engine : str, optional
        As in :func:`~quasistatic_ref.solve.engines.solver_for`; by default ``"native"`` where that
        reaches the backend and the cone, and ``"cvxpy"`` for extensions that are not linear
        constraints alone.
    cone : str
        Friction cone of every contact; see :mod:`~quasistatic_ref.step.cones`.
    extension : callable, optional
        A function of q that returns the user's own constraints and costs for the step from q.
    limits : Limits, optional
        Penetration and reach beyond which a run ends; by default those of
        :class:`~quasistatic_ref.simulate.limits.Limits`.

    Attributes
    ----------
    backend : str
        Name of the backend.
    fast : callable or None
        The compiled implementation of :meth:`step`, with the same bits; None if there is none for
        this simulator.
    solver : Solver or None
        The object that solved the last step; it solves the next one, too, if that step fits it.

    Raises
    ------
    StepDataError
        If K_q, or M_u at the start, is not symmetric positive definite, or h not positive.
    BackendError
        If the backend is unknown or not installed, or the engine does not reach it.
    """

    def __init__(
        self,
        system: System,
        pairs: Sequence[ContactPair],
        *,
        h: float,
        K_q: Array,
        gravity: Sequence[float] = GRAVITY,
        gravity_acts: Array | None = None,
        solver: str | None = None,
        engine: str | None = None,
        accuracy: float = ACCURACY,
        certify: str = "full",
        cone: str = PYRAMID,
        extension: Callable[[Array], Extension] | None = None,
        limits: Limits | None = None,
    ) -> None:
        self.system, self.pairs, self.layout = system, tuple(pairs), contact_layout(pairs)
        self.gravity = tuple(np.asarray(gravity, dtype=np.float64).tolist())
        self.gravity_acts = np.ones(system.n_v)
        self.gravity_acts[: system.n_a] = False if gravity_acts is None else gravity_acts
        self.extension, self.limits = extension, Limits() if limits is None else limits
        self.requested_backend, self.requested_engine = solver, engine
        self.accuracy, self.certify = accuracy, certify
        blocks = extension is None and system.constant_mass_matrix
        entries = 4 * len(self.layout.rows) * system.n_v if blocks else 0
        default = default_backend(engine, cone, certify, entries)
        self.backend = default if solver is None else solver
        self.engine = default_engine(self.backend, cone) if engine is None else engine
        check_solver(self.backend, self.engine, cone, certify)
        self.solver: Solver | None = None
        self.spare = Spare(default, self.engine, accuracy, certify)
        self.tracker = ContactTracker(self.pairs)
        least = sparse_from(self.engine, self.backend, certify, cone) if blocks else 0
        self.geometry = contact_geometry(self.layout, system.motion, least)
        M_u = system.mass_blocks if self.geometry.in_blocks else system.M_u(system.q_start)
        self.constant = constants(h, K_q, system.n_a, M_u, self.layout.rows, cone)
        self.h, self.K_q, self.cone = self.constant.h, self.constant.K_q, cone
        fast = compiled("step")
        self.fast: CompiledStep | None = None if fast is None else fast.compiled_step(self)

    def __reduce__(self) -> tuple[Any, ...]:
        same = ("h", "K_q", "gravity", "accuracy", "certify", "cone", "extension", "limits")
        settings: dict[str, Any] = {name: getattr(self, name) for name in same}
        settings |= {"solver": self.requested_backend, "engine": self.requested_engine}
        settings["gravity_acts"] = self.gravity_acts[: self.system.n_a]
        return _remade, (type(self), self.system, self.pairs, settings)

    @by_one_thread
    def step(self, q: Array, q_bar_a: Array, force: Array | float = 0.0) -> StepResult:
        """One step from q towards the target q_bar_a.

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        q_bar_a : ndarray, shape (n_q_a,)
            Target of the actuated coordinates at the end of the step.
        force : ndarray, shape (n_v,), optional
            External generalised force, in addition to gravity [N, N m].

        Returns
        -------
        StepResult

        Raises
        ------
        StepDataError
            If the force has another shape, or a number is not finite.
        InputError
            If another thread is taking a step of the same system.
        ModelError
            If q or q_bar_a has another shape.
        ContactError
            If a pair has no trustworthy normal at q, or q is not finite.
        StepNotSolved
            If the backend's answer cannot be trusted, the step has no solution, or it
            starts or ends beyond the limits.
        """
        if self.fast is not None and (taken := self.fast(self, q, q_bar_a, force)) is not None:
            return taken  # the same numbers, by compiled code
        lap = Stopwatch()
        kinematics = self.system.kinematics(q)
        points = self.tracker.closest_points(kinematics.R, kinematics.t)
        lap("distances")
        step, own = self.extended(self.step_data(q, q_bar_a, force, points, kinematics), q)
        lap("rows")
        solution = self.solution(step, own)  # Eq. (13)
        self.limits.check_penetration(step)  # after the solve: a proof of infeasibility says more
        lap("solve")
        q_next = self.system.integrate(q, solution.delta_q)  # q (+) delta_q
        self.limits.check_reach(step, self.system.links, self.system.kinematics(q_next).t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, lap.seconds)

    def step_data(
        self,
        q: Array,
        q_bar_a: Array,
        force: Array | float,
        points: ClosestPoints,
        kinematics: Kinematics,
    ) -> StepData:
        """The problem of one step: everything in Eq. :eq:`eq-13` at q.

        Raises
        ------
        StepDataError
            If the force has another shape.
        """
        contacts = self.geometry.contacts(points, kinematics)  # Eqs. (2)-(3)
        delta_q_bar_a = self.system.actuated_difference(q, q_bar_a)  # q_bar_a(t + h) (-) q_a
        return self.posed(q, force, delta_q_bar_a, contacts)

    def posed(
        self,
        q: Array,
        force: Array | float,
        delta_q_bar_a: Array,
        contacts: Points,
    ) -> StepData:
        """The problem of a step with this target and these contacts; StepDataError as above."""
        system, n_a = self.system, self.system.n_a
        if np.shape(force) not in {(), self.gravity_acts.shape}:
            problem = f"must have shape {self.gravity_acts.shape}"
            raise StepDataError(problem, field="force", value=np.shape(force))
        tau = self.gravity_acts * system.gravity_force(q, self.gravity) + force
        constant = self.constant if system.constant_mass_matrix else self.constant.at(system.M_u(q))
        return constant.kind(constant, tau[:n_a], tau[n_a:], delta_q_bar_a, contacts)

    def extended(self, step: StepData, q: Array) -> tuple[StepData, Extension | None]:
        """The step with the user's own rows at q, shape (n_q,); and the extension or None.

        An extension that holds costs or nonlinear constraints is returned with the unchanged
        step; the linear constraints of any other become rows of the step.
        """
        if self.extension is None:
            return step, None
        extended = needed_part("extensions.extended", "extension")  # it needs CVXPY
        own = self.extension(q)
        rows = extended.extension_rows(step, own)
        return (step, own) if rows is None else (extended.with_rows(step, rows), None)

    def fitting(self, step: StepData) -> Solver:
        """The solver of the last step if it fits this step, else a new one."""
        if self.solver is None or not self.solver.fits(step):
            self.solver = solver_for(step, self.backend, self.engine)
        return self.solver

    def solution(self, step: StepData, extension: Extension | None = None) -> StepSolution:
        """A step solved, perhaps with nonlinear constraints or costs of an extension."""
        own = self.fitting(step)
        by_name = extension is not None and (self.requested_engine or CVXPY) == CVXPY
        solver = (self.requested_backend or DEFAULT) if by_name else own
        first = partial(solve_step, step, solver, accuracy=self.accuracy, certify=self.certify)
        return self.spare.after(step, partial(first, extension=extension))
