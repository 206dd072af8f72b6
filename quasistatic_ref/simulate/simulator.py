"""The simulator: one step as the algorithm of the paper."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import FrozenInstanceError, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.groups import coupled_groups, flat_rows
from quasistatic_ref.contact.all_pairs import AllPairs
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactPair, checked_pairs, contact_layout
from quasistatic_ref.errors import InputError, StepDataError, check_kind, keywords_named
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import (
    Array,
    Mask,
    all_finite,
    checked_array,
    checked_numbers,
    read_only,
    without_warnings,
)
from quasistatic_ref.numbers.pivots import positive_definite
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.distances import Distances, measured_pairs
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX, COULOMB, Law
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.simulate.standing import Standings
from quasistatic_ref.simulate.steps import Steps, Ways, targets_and_loads
from quasistatic_ref.simulate.stiffness import stiffness_matrix
from quasistatic_ref.solve.backends import DAQP, DEFAULT, NONE, Certify, spares
from quasistatic_ref.solve.by_group import GroupLayout
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.many import KnownAnswers, ManyLoads
from quasistatic_ref.solve.solve import solution_of, solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData, no_extra, row_layout, seconds
from quasistatic_ref.step.extension import ExtensionOfQ, StepExtension
from quasistatic_ref.step.hessian import Hessian, hessian
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.text.quoting import counted
from quasistatic_ref.text.shown import Shown

GRAVITY = (0.0, 0.0, -9.81)
FROM_LOADS = 'system.load(q, "BODY", force=(1, 0, 0)) makes it from a force in world axes'
NO_FORCE = read_only(np.zeros(()))
CoulombSolution = Callable[[StepData, Solver, float], StepSolution]
"""A step, its solver and the accuracy [-] -> its solution under Coulomb's law."""
ExtendedSolution = Callable[["Simulator", StepData, StepExtension], StepSolution]
"""A simulator, its step and what a user adds -> its solution."""
SceneFindings = Callable[["Simulator", Array, Array], list[Finding]]
StandingsOf = Callable[["Simulator", ArrayLike, ArrayLike, ArrayLike | None, str], Standings]
"""A simulator, q (n_q,) and a force (n_v,) [N, N m] -> what is wrong with the scene."""


@contextmanager
def by_one_thread(system: Mechanism) -> Iterator[None]:
    """A context for one step of a system; it refuses a second thread.

    Raises
    ------
    InputError
    """
    if not system.lock.acquire(blocking=False):
        problem = "another thread is using the same system; "
        problem += "give each thread its own copy, copy.deepcopy(simulator)"
        raise InputError(problem, field="simulator")
    try:
        yield
    finally:
        system.lock.release()


def stopwatch(times: dict[str, float]) -> Callable[[str], None]:
    """A function that writes the wall time [s] since its last call into `times`, by a name."""
    last = time.perf_counter()

    def lap(name: str) -> None:
        nonlocal last
        now = time.perf_counter()
        times[name] = now - last
        last = now

    return lap


def _checked_acts(acts: ArrayLike, n_a: int) -> Mask:
    """Whether gravity acts on each actuated coordinate, shape (n_a,); StepDataError if unclear."""
    entries = np.array(acts, dtype=object)
    if not all(entry in (0, 1) for entry in entries.ravel().tolist()):
        problem = "must be true or false for each actuated coordinate"
        raise StepDataError(problem, field="gravity_acts", value=acts)
    checked: Mask = checked_array(entries.astype(np.float64), "gravity_acts", (n_a,)) != 0
    return checked


def checked_force(system: System, force: ArrayLike | None) -> Array:
    """A generalised force, shape (n_v,) or () [N, N m]; zero where None.

    Raises
    ------
    StepDataError
        If it has another shape, or is no array of numbers.
    """
    if force is None or (type(force) is float and force == 0):
        return NO_FORCE
    tau = None if isinstance(force, Mapping) else checked_numbers(force, "force")
    if tau is None or (tau.shape != (system.n_v,) and not (tau.shape == () and tau == 0)):
        problem = f"must be numbers of shape ({system.n_v},), in the order of delta_q; {FROM_LOADS}"
        raise StepDataError(problem, field="force", value=force if tau is None else tau.shape)
    return tau


def _remade(kind: type[Simulator], settings: dict[str, Any]) -> Simulator:
    """A new simulator from the arguments of another, as a deep copy needs it."""
    return kind(**settings)


class Simulator(Settings, Shown):
    """Takes steps of a system: finds contacts, builds the program of Eq. (13), and solves it.

    A simulator keeps what is slow to make and serves many steps: which coordinates move which
    contact, the solver. A copy is a new simulator with the same settings. Simulators of one system
    are for one thread: a step that is asked for while another thread takes one is refused. A deep
    copy has a system of its own.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    h : float
        Time step [s].
    K_q : ndarray, shape (n_a, n_a); or its diagonal, a number, or a mapping of joints to these; {}
        Stiffness of the actuated coordinates [N/m, N m/rad], in the order of delta_q; see
        :func:`~quasistatic_ref.simulate.stiffness.stiffness_matrix`.
    gravity : array_like, shape (3,)
        [m/s^2], world frame.
    gravity_acts : ndarray of bool, shape (n_a,), optional
        Whether gravity acts on each actuated coordinate; by default on none, as if the robot
        compensated its own weight.
    backend : str, optional
        Name of a backend, as `solver` of :func:`~quasistatic_ref.solve.solve.solve_step`, of which
        `accuracy` and `certify` are arguments too.
    cone : str
        Friction cone of every contact; see :mod:`~quasistatic_ref.step.cones`.
    law : str
        ``"convex"``, the model's, or ``"coulomb"``, without the rise of sliding contacts: each step
        is then a :class:`~quasistatic_ref.optional.coulomb.fixed_point.CoulombSolution`.
    distances : str
        ``"closed"``, closed forms, or ``"coal"``: coal's distances and normals of points of clouds,
        on boxes, spheres, capsules and half-spaces.
    extension : callable, optional
        A function of q that returns the user's own constraints and costs for the step from q.
    limits : Limits, optional
        Penetration and reach beyond which a run ends; by default those of
        :class:`~quasistatic_ref.simulate.limits.Limits`.

    Attributes
    ----------
    backend : str
        Name of the backend.
    solver : Solver or None
        The object that solved the last step; it solves the next one, too, if that step fits it.
    working_set : tuple of int
        Without a backend: rows of the last step, from which the next one is solved.

    Raises
    ------
    StepDataError
        If K_q is not symmetric positive definite, or h not positive.
    BackendError
        If the backend is unknown or not installed, or does not take the cone.
    InputError
        If the law is unknown or does not take `certify`, or the distances are unknown.
    ContactError
        If the distances do not suit a pair.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> simulator.step(q).q.round(6)  # place [m] and quaternion
    array([0.  , 0.  , 0.05, 0.  , 0.  , 0.  , 1.  ])
    """

    replaceable: ClassVar[tuple[str, ...]] = (DEFAULT, DAQP)

    @keywords_named
    def __init__(
        self,
        system: System,
        pairs: Sequence[ContactPair],
        *,
        h: float,
        K_q: ArrayLike | Mapping[str, ArrayLike] = MappingProxyType({}),
        gravity: Sequence[float] = GRAVITY,
        gravity_acts: ArrayLike | None = None,
        backend: str | None = None,
        accuracy: float = Settings.accuracy,
        certify: Certify = Settings.certify,
        cone: str = Settings.cone,
        law: Law = Settings.law,
        distances: Distances = Settings.distances,
        extension: ExtensionOfQ | None = None,
        limits: Limits | None = None,
    ) -> None:
        check_kind(system, Mechanism, "system", "a System, as System([body]) makes it")
        pairs = checked_pairs(pairs)
        acts = np.zeros(system.n_a) if gravity_acts is None else gravity_acts
        super().__init__(
            system=system,
            pairs=pairs,
            h=seconds(h),
            K_q=stiffness_matrix(system, K_q),
            gravity=checked_array(gravity, "gravity", (3,)),
            gravity_acts=_checked_acts(acts, system.n_a),
            backend=DEFAULT if backend is None else backend,
            accuracy=accuracy,
            certify=certify,
            cone=cone,
            law=law,
            distances=distances,
            limits=Limits() if limits is None else limits,
        )
        self.extension = extension
        self.named_backend = backend
        self.layout = contact_layout(pairs)
        self.solver: Solver | None = None
        self.spares: dict[str, Solver] = {}
        self.working_set: tuple[int, ...] = ()
        # H of Eq. (13): refused where it leaves float64's range
        if system.constant_mass_matrix:
            largest = np.abs(system.mass_blocks).max(axis=0, initial=0.0)
        else:
            largest = system.M_u(system.q_start)
        hessian(self.h, self.K_q, largest)
        self._hessian: Hessian | None = None

    def __setattr__(self, name: str, value: object) -> None:
        try:
            super().__setattr__(name, value)
        except FrozenInstanceError:
            problem = "is fixed when a simulator is made, as is what was formed of it; make another"
            raise InputError(problem, field=f"simulator.{name}", value=value) from None

    @cached_property
    def all_pairs(self) -> AllPairs:
        """The pairs of this simulator, arranged for a joint search of closest points."""
        return AllPairs(measured_pairs(self.pairs, self.distances))

    @cached_property
    def geometry(self) -> ContactGeometry:
        """The constant part of the contacts' Jacobians: which coordinates move which contact."""
        return ContactGeometry(self.layout, self.system.column_map)

    @cached_property
    def group_layout(self) -> GroupLayout | None:
        """The groups of all steps, by what can couple their coordinates; None if not known."""
        system = self.system
        entries = system.mass_entries
        if entries is None:
            return None
        contact, k = np.nonzero(self.geometry.column < system.n_v)
        of_contacts = contact, self.geometry.column[contact, k]
        i, j = entries
        of_K, of_K_column = np.nonzero(self.K_q)
        n_a = system.n_a
        of_H = np.concatenate([of_K, n_a + i]), np.concatenate([of_K_column, n_a + j])
        counts = row_layout(self.cone, self.layout.rows.tobytes()).counts
        every = coupled_groups(of_contacts, of_H, counts, system.n_v)
        return GroupLayout(every, self.geometry.column, counts, system.n_v, 0, len(of_H[0]))

    def scaled(self, step: StepData) -> ScaledStep:
        """A step with its program, by the groups of the simulator if it has its structure."""
        own = step.contacts.column is self.geometry.column and step.extra.empty
        return ScaledStep(step, layout=self.group_layout if own else None)

    def __repr__(self) -> str:
        contacts = counted(sum(pair.n_c for pair in self.pairs), "contact")
        settings = f"h = {self.h:g} s, {contacts}, cone {self.cone}, backend {self.backend}"
        return f"<{type(self).__name__} of {self.system!r}: {settings}>"

    def __reduce__(self) -> tuple[object, ...]:
        chosen = {"backend": self.named_backend, "extension": self.extension}
        return _remade, (type(self), self.settings() | chosen)

    def step(
        self, q: ArrayLike | State, q_bar_a: ArrayLike = (), force: ArrayLike | None = 0.0
    ) -> StepResult:
        """One step from q towards the target q_bar_a.

        Parameters
        ----------
        q : array_like, shape (n_q,); or State
            A state is not computed again: the ``end`` of the last step, ``system.at(q)``.
        q_bar_a : array_like, shape (n_q_a,)
            Target of the actuated coordinates at the end of the step; left out where there are
            none.
        force : array_like, shape (n_v,), optional
            External generalised force, in addition to gravity [N, N m]; `system.load` makes it.

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
        with by_one_thread(self.system):
            times: dict[str, float] = {}
            lap = stopwatch(times)
            here = self.system.at(q)
            points = self.closest_points(here.kinematics)
            lap("distances")
            step = self.step_data(here, q_bar_a, force, points)
            lap("rows")
            solution = self.extended(step, here.q)
            # After the solve: a proof of infeasibility says more.
            self.limits.check_penetration(step)
            # An extension adds rows and coordinates: from here on the step is the one that was
            # solved. Without an extension it is the same.
            step = solution.step
            lap("solve")
            times["proof"] = solution.statistics.proof_time
            times["solve"] -= times["proof"]
            delta_q = solution.delta_q[: self.system.n_v]
            end = here.plus(delta_q)  # q (+) delta_q
            self.limits.check_reach(step, self.system.links, end.kinematics.t)
            lap("integrate")
            return StepResult(end.q, step, solution, points, times, here.q, self, end)

    def steps(
        self, q: ArrayLike | State, targets: ArrayLike, force: ArrayLike | None = None
    ) -> Steps:
        """Steps from one state towards many targets, or under many loads.

        Contacts, J, H and A depend on q alone, and are formed once. Each step starts cold, so that
        no answer depends on the order of the targets; what is certified is as :meth:`step` has it.

        Parameters
        ----------
        q : array_like, shape (n_q,); or State
        targets : array_like, shape (N, n_q_a); or (n_q_a,), for all
        force : array_like, shape (N, n_v); or (n_v,), for all; optional
            External generalised forces, in addition to gravity [N, N m].

        Returns
        -------
        Steps
            Arrays ``q`` (N, n_q), ``delta_q`` (N, n_v) and ``lam`` (N, m); item i is a StepResult.

        Raises
        ------
        QuasistaticError
            As of :meth:`step`, of the first step that has no answer.
        """
        system = self.system
        with by_one_thread(system):
            here = system.at(q)
            q_bar_a, loads = targets_and_loads(system, targets, force)
            points = self.closest_points(here.kinematics)
            contacts = self.geometry.contacts(points, here.kinematics)
            tau = self.generalised_force(here, None) + loads
            changes = here.changes_to(q_bar_a) + 0.0
            bad = np.flatnonzero(~np.isfinite(np.hstack([changes, tau])).all(axis=1)).tolist()
            if len(tau):
                k = bad[0] if bad else 0
                first = self.step_under(here, q_bar_a[k], tau[k], contacts)  # or its refusal
            else:
                q_a = here.q[: system.n_q_a]
                first = self.step_under(here, q_a, np.zeros(system.n_v), contacts)
            kept = self.solver, self.working_set
            try:
                answers = self._answers(ManyLoads(first, changes, tau), here)
            finally:
                self.solver, self.working_set = kept
            return Steps(self, here, points, first, *answers)

    def _answers(
        self, many: ManyLoads, here: State
    ) -> tuple[Array, Array, Callable[[int], StepSolution]]:
        """delta_q (N, n_v), lam (N, m) of steps from one state, and what gives their solutions."""
        first = many.first
        scaled = self.scaled(first)
        found: dict[int, StepSolution] = {}
        known: KnownAnswers | None = None
        if self.backend == DAQP and self.law == CONVEX and self.extension is None:
            solver = solver_for(first, DAQP)
            known = without_warnings(KnownAnswers, many, scaled, solver, self.accuracy)

        def solution(k: int) -> StepSolution:
            if k in found:
                return found[k]
            step = many.step(k)
            if known is not None:
                try:
                    return self.solved(known.scaled(k, step), known.solver(k))
                except StepNotSolved as failure:
                    return self.otherwise_solved(step, failure)
            self.start_cold()
            return self.extended(step, here.q)

        unproved = known is not None and self.certify == "off"
        delta_q = known.delta_q if known is not None else np.zeros((len(many), first.n_v))
        lam = known.lam if known is not None else np.zeros((len(many), first.m))
        n_v = self.system.n_v
        for k in known.failed if unproved and known is not None else range(len(many)):
            found[k] = one = solution(k)
            delta_q[k] = one.delta_q[:n_v]
            if lam.shape[1] != len(one.lam):  # with rows of an extension
                lam = np.zeros((len(many), len(one.lam)))
            lam[k] = one.lam
        self.limits.check_penetration(first)
        bounds = self._ways.farthest(here.kinematics.t, delta_q)
        for k in np.flatnonzero(~(bounds <= self.limits.reach)).tolist():
            end = here.plus(delta_q[k]).kinematics
            self.limits.check_reach(many.step(k), self.system.links, end.t)
        return delta_q, lam, solution

    @cached_property
    def _ways(self) -> Ways:
        return Ways(self.system)

    def start_cold(self) -> None:
        """Forget all that answers of later steps could depend on."""
        self.working_set = ()
        if self.solver is not None and self.solver.remembers:
            self.solver = None

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """The contacts of all pairs, in order, each pair's in ascending distance.

        Raises
        ------
        ContactError
            If a pair has no trustworthy normal, or a pose is not finite.
        """
        return self.all_pairs.closest_points(kinematics)

    def step_data(
        self,
        q: ArrayLike | State,
        q_bar_a: ArrayLike,
        force: ArrayLike | None,
        points: ClosestPoints,
    ) -> StepData:
        """The problem of one step: everything in Eq. :eq:`eq-13` at q, (n_q,) or a state.

        Raises
        ------
        StepDataError
            If the force has another shape.
        """
        here = self.system.at(q)
        return self.step_at(here, q_bar_a, self.generalised_force(here, force), points)

    def step_at(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, tau: Array, points: ClosestPoints
    ) -> StepData:
        """The problem of one step from its closest points and all forces, (n_v,) [N, N m]."""
        here = self.system.at(q)
        contacts = self.geometry.contacts(points, here.kinematics)  # Eqs. (2)-(3)
        return self.step_under(here, q_bar_a, tau, contacts)

    def step_under(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, tau: Array, contacts: Contacts
    ) -> StepData:
        """The problem of one step from its contacts and all generalised forces, (n_v,) [N, N m]."""
        system = self.system
        here = system.at(q)
        masses = here.masses
        change = here.change_to(q_bar_a)  # q_bar_a(t + h) (-) q_a
        n_a = system.n_a
        loads: dict[str, Any] = {"tau_a": tau[:n_a], "tau_u": tau[n_a:], "delta_q_bar_a": change}
        numbers = (masses, tau, change, contacts.phi, contacts.n, contacts.own)
        if not all(all_finite(array.ravel()) for array in numbers):  # refused by their names
            loads |= {"contacts": replace(contacts), "cone": self.cone}
            return StepData(h=self.h, K_q=self.K_q, M_u=here.M_u, **loads)
        last = self._hessian
        if last is None or not (masses is last.masses or np.array_equal(masses, last.masses)):
            positive_definite("M_u", masses)
            new = Hessian(self.h, self.K_q, masses) if last is None else last.changed(masses)
            self._hessian = last = new
        return StepData.unchecked(
            h=self.h,
            K_q=self.K_q,
            hessian=last,
            contacts=contacts,
            cone=self.cone,
            extra=no_extra(system.n_v),
            **{name: read_only(load + 0.0) for name, load in loads.items()},
        )

    def generalised_force(self, q: ArrayLike | State, force: ArrayLike | None) -> Array:
        """Gravity at q plus an external `force`, shape (n_v,) [N, N m]."""
        force = checked_force(self.system, force)
        tau = self.system.at(q).gravity(self.gravity)
        tau[: self.system.n_a] *= self.gravity_acts
        return tau + force

    def findings(
        self, q: ArrayLike | None = None, force: ArrayLike | None = None
    ) -> tuple[Finding, ...]:
        """What is wrong with the scene at q, shape (n_q,), by default where the system starts.

        A `force`, shape (n_v,) [N, N m], pushes there.

        Raises
        ------
        InputError
            If there is no ``optional/doctor``.
        """
        q = self.system.q_start if q is None else self.system.checked(q)
        scene_findings: SceneFindings = part("scene_findings")
        return tuple(scene_findings(self, q, checked_force(self.system, force)))

    def stands(
        self,
        q: ArrayLike | None = None,
        target: ArrayLike | None = None,
        force: ArrayLike | None = None,
        *,
        certify: str = "off",
    ) -> Standings:
        """Whether each body would stay at q, if the target and a force stayed as they are.

        Parameters
        ----------
        q : array_like, shape (n_q,), optional
            By default where the system starts.
        target : array_like, shape (n_q_a,), optional
            q_bar_a; by default q.
        force : array_like, shape (n_v,), optional
            In addition to gravity [N, N m].
        certify : str
            ``"full"``: the ends of all iterations are proved; ``"off"``: none.

        Returns
        -------
        Standings
            A row a body.

        Raises
        ------
        InputError
            If there is no ``optional/stands``, or `certify` is none of these words.
        ModelError, StepDataError, ContactError
            As of :meth:`step`.
        """
        q = self.system.q_start if q is None else self.system.checked(q)
        target = q[: self.system.n_q_a] if target is None else target
        standings: StandingsOf = part("stands")
        return standings(self, q, target, force, certify)

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
