"""The simulator: one step as the algorithm of the paper."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import FrozenInstanceError
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.contact.pairs import ContactPair, checked_pairs
from quasistatic_ref.errors import InputError, StepDataError, check_kind, keywords_named
from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Mask, checked_array, without_warnings
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import counted
from quasistatic_ref.shown import Shown
from quasistatic_ref.simulate.distance_source import Distances
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.form_step import checked_force, form_step
from quasistatic_ref.simulate.law import CONVEX, Law
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.simulate.standing import Standings
from quasistatic_ref.simulate.step_solver import StepSolver
from quasistatic_ref.simulate.steps import ReachBound, Steps, targets_and_loads
from quasistatic_ref.simulate.stiffness import stiffness_matrix
from quasistatic_ref.solve.backends import DAQP, DEFAULT, Certify
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.many import ManyLoads, PrecomputedReplies
from quasistatic_ref.step.data import seconds
from quasistatic_ref.step.extension import ExtensionOfQ, Posed
from quasistatic_ref.step.hessian import hessian
from quasistatic_ref.step.solution import StepSolution

GRAVITY = (0.0, 0.0, -9.81)
SceneFindings = Callable[["Simulator", Array, Array], list[Finding]]
"""A simulator, q (n_q,) and a force (n_v,) [N, N m] -> what is wrong with the scene."""
StandingsOf = Callable[["Simulator", ArrayLike, ArrayLike, ArrayLike | None, str], Standings]
"""A simulator, q (n_q,), q_bar_a (n_q_a,), a force (n_v,) [N, N m], certify -> what stands."""


@contextmanager
def by_one_thread(system: Mechanism) -> Iterator[None]:
    """A context for one step of a system; it refuses a second thread.

    Raises
    ------
    InputError
    """
    if not system.lock.acquire(blocking=False):
        problem = (
            "another thread is using the same system; "
            "give each thread its own copy, copy.deepcopy(simulator)"
        )
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


def _remade(kind: type[Simulator], settings: dict[str, Any]) -> Simulator:
    """A new simulator from the arguments of another, as a deep copy needs it."""
    return kind(**settings)


class Simulator(StepSolver, Shown):
    """Takes steps of a system: finds contacts, builds the program of Eq. (13), and solves it.

    A simulator keeps what is slow to make and serves many steps: which coordinates move which
    contact, the solver. A copy is a new simulator with the same settings. Simulators of one system
    take steps in one thread: a step that is asked for while another thread takes one is refused.
    All else may be asked in any thread. A deep copy has a system of its own.

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
        acts = np.zeros(system.n_a) if gravity_acts is None else gravity_acts
        super().__init__(
            system=system,
            pairs=checked_pairs(pairs),
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
        self.named_backend = None if backend is None else self.backend
        # H of Eq. (13): refused where it leaves float64's range
        if system.constant_mass_matrix:
            largest = np.abs(system.mass_blocks).max(axis=0, initial=0.0)
        else:
            largest = system.M_u(system.q_start)
        hessian(self.h, self.K_q, largest)

    def __setattr__(self, name: str, value: object) -> None:
        try:
            super().__setattr__(name, value)
        except FrozenInstanceError:
            problem = "is fixed when a simulator is made, as is what was formed of it; make another"
            raise InputError(problem, field=f"simulator.{name}", value=value) from None

    def __repr__(self) -> str:
        contacts = counted(sum(pair.n_c for pair in self.pairs), "contact")
        settings = f"h = {self.h:g} s, {contacts}, cone {self.cone}, backend {self.backend}"
        return f"<{type(self).__name__} of {self.system!r}: {settings}>"

    def __reduce__(self) -> tuple[object, ...]:
        chosen = {"backend": self.named_backend, "extension": self.extension}
        return _remade, (type(self), self.settings() | chosen)

    def step(
        self, q: ArrayLike | State, q_bar_a: ArrayLike = (), force: ArrayLike | None = None
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
            step = form_step(self.plan, here, q_bar_a, force, points)
            lap("rows")
            solution = self.solution(step, here.q)
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
            self.limits.check_reach(step, self.system.links, end.t)
            lap("integrate")
            return StepResult.unchecked(  # a state's q is a copy, and read-only
                q=end.q,
                step=step,
                solution=solution,
                points=points,
                seconds=times,
                end=end,
                q_start=here.q,
                scene=self,
            )

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
            tau = self.generalised_force(here, None) + loads
            changes = here.changes_to(q_bar_a) + 0.0
            if len(tau):
                k = np.isfinite(np.hstack([changes, tau])).all(axis=1).argmin()
                first = form_step(self.plan, here, q_bar_a[k], loads[k], points)  # or its refusal
            else:
                q_a = here.q[: system.n_q_a]
                first = form_step(self.plan, here, q_a, None, points)
            kept = self.solver, self.working_set
            try:
                solutions = self._solutions(ManyLoads(first, changes, tau), here)
            finally:
                self.solver, self.working_set = kept
            return Steps(self, here, points, first, *solutions)

    def _solutions(
        self, many: ManyLoads, here: State
    ) -> tuple[Array, Array, Callable[[int], StepSolution]]:
        """delta_q (N, n_v), lam (N, m) of steps from one state, and what gives their solutions."""
        found: dict[int, StepSolution] = {}
        known: PrecomputedReplies | None = None
        posed = self._posed(many, here) if self.backend == DAQP and self.law == CONVEX else None
        if posed is not None:
            natural = self.natural_step(posed.first)
            solver = solver_for(posed.first, DAQP)
            known = without_warnings(PrecomputedReplies, posed, natural, solver, self.accuracy)
        many = many if posed is None else posed
        first = many.first

        def solution(k: int) -> StepSolution:
            if k in found:
                return found[k]
            step = many.step(k)
            if known is not None:
                return self.solution(step, precomputed=(known.natural(k, step), known.solver(k)))
            self.start_cold()
            return self.solution(step, here.q)

        n_v = self.system.n_v
        delta_q = np.zeros((len(many), n_v))
        lam = np.zeros((len(many), first.m))
        if known is not None:
            delta_q = known.delta_q[:, :n_v].copy()
            lam = known.lam
        for k in known.failed if known is not None and self.certify == "off" else range(len(many)):
            found[k] = one = solution(k)
            delta_q[k] = one.delta_q[:n_v]
            if lam.shape[1] != len(one.lam):  # with rows of an extension
                lam = np.zeros((len(many), len(one.lam)))
            lam[k] = one.lam
        self.limits.check_penetration(first)
        bounds = self._reach_bound.farthest(here.kinematics.t, delta_q)
        for k in np.flatnonzero(~(bounds <= self.limits.reach)).tolist():
            end = here.plus(delta_q[k]).kinematics
            self.limits.check_reach(many.step(k), self.system.links, end.t)
        return delta_q, lam, solution

    def _posed(self, many: ManyLoads, here: State) -> ManyLoads | None:
        """Steps from one state with what the user adds; None where that may depend on the loads."""
        if self.extension is None:
            return many
        extension = self.extension(here.q)
        if not getattr(extension, "same_for_all_loads", False):  # of no kind that is known: refused
            return None
        posed: Posed = part("posed")
        first, whole = posed(many.first, extension)
        return many.posed(first) if whole else None

    @cached_property
    def _reach_bound(self) -> ReachBound:
        return ReachBound(self.system)

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
